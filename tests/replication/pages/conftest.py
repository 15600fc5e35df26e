"""A project with a synthetic campaign, from which all pages can be written."""

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from replication.campaign import DOUBLE
from replication.config import Study, root_of
from replication.judgement import Evidence, summarise, written
from replication.judgement.claims import judge
from replication.running import write
from replication.training import ERRORS, KINDS, Place, places
from tests.conftest import ROOT, changed
from tests.replication.plots.conftest import outcomes

COMMITTED = "config.yaml", "pyproject.toml", "workflow/deviations.yaml"
DESIGN = "workflow/campaign/design.csv"
INITIAL, FINAL = (8.4, 4.7), (0.32, 0.23)  # cm, degrees


def history(iterations: int) -> pd.DataFrame:
    """Errors of two seeds before and after learning; they differ by 2 %."""
    rows = [
        {"iterations": iterations, "seed": seed, "iteration": iteration}
        | {"moves": 2 * iteration, "refused": 0}
        | {error: value * (0.99 + 0.02 * seed) for error, value in zip(ERRORS, errors, strict=True)}
        for seed in range(2)
        for iteration, errors in ((0, INITIAL), (iterations, FINAL))
    ]
    return pd.DataFrame(rows)


@pytest.fixture(scope="session")
def project(tmp_path_factory) -> Callable[[Study, int], Path]:
    """Makes the folder of a project in which so many setups have been measured."""

    def make(study: Study, setups: int) -> Path:
        folder = tmp_path_factory.mktemp("project")
        for name in (*COMMITTED, DESIGN):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
        shutil.copytree(ROOT / "workflow" / "templates", folder / "workflow" / "templates")
        root, histories = folder / root_of(study.name), []
        for place, learners in places(study).items():
            for learner, lengths in learners.items():
                histories.append(folder / place.history_file(root_of(study.name), learner))
                write(histories[-1], pd.concat(map(history, lengths)))
        own = Place(study.robot, study.scenario).scenario_file(root_of(study.name))
        write(folder / own, {"damages": [{"link": "forearm_link", "shorten": "1 cm"}]})
        distances = pd.DataFrame({"distance": np.linspace(0, 1, 5760)})
        write(root / "assignments" / f"{study.robot}.parquet", distances)
        write(root / "summary.csv", summarise(study, histories))
        if setups:
            table = outcomes(changed(study, campaign={"setups": setups}))
            campaign = folder / "workflow" / "campaign"
            write(campaign / "outcomes.csv", table)
            last = table[table["variant"] == DOUBLE].query("setup > 0 and iterations == 20_000")
            shares = [f"{kind}_share" for kind in KINDS]
            halfway = last.assign(iterations=10_000, **(2 * last[shares]))
            write(campaign / "halfway.csv", halfway)
        write(root / "claims.json", written(judge(Evidence(study, folder))))
        return folder

    return make
