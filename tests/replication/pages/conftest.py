"""A project with a synthetic campaign, from which all pages can be written."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from replication.config import Study, root_of
from replication.judgement import Evidence, written
from replication.judgement.claims import judge
from replication.training import ERRORS, Place, places
from tests.conftest import ROOT, changed
from tests.replication.plots.conftest import outcomes

COMMITTED = "config.yaml", "pyproject.toml", "workflow/deviations.yaml"
CAMPAIGN = "workflow/campaign/design.csv", "workflow/campaign/second.yaml"
INITIAL, FINAL = (8.4, 4.7), (0.32, 0.23)  # cm, degrees


def summary(study: Study) -> pd.DataFrame:
    """Errors of the main learners in the study's own scenario."""
    rows = [
        {"robot": study.robot, "scenario": study.scenario, "learner": learner, "iterations": its}
        | {"seeds": 20, "moves": 2 * its}
        | {f"initial_{error}": value for error, value in zip(ERRORS, INITIAL, strict=True)}
        | {f"final_{error}": value for error, value in zip(ERRORS, FINAL, strict=True)}
        for learner, lengths in study.experiments.learners.items()
        for its in lengths
    ]
    return pd.DataFrame(rows)


def history(iterations: int) -> pd.DataFrame:
    """Errors of two seeds before and after learning; their logarithms differ by 0.02."""
    rows = [
        {"iterations": iterations, "seed": seed, "iteration": iteration}
        | {error: value * np.exp(0.02 * seed) for error, value in zip(ERRORS, errors, strict=True)}
        for seed in range(2)
        for iteration, errors in ((0, INITIAL), (iterations, FINAL))
    ]
    return pd.DataFrame(rows)


@pytest.fixture(scope="session")
def project(tmp_path_factory) -> Callable[[Study, int], Path]:
    """Makes the folder of a project in which so many setups have been measured."""

    def make(study: Study, setups: int) -> Path:
        folder = tmp_path_factory.mktemp("project")
        for name in (*COMMITTED, *CAMPAIGN):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, folder / name)
        shutil.copytree(ROOT / "workflow" / "templates", folder / "workflow" / "templates")
        evidence = Evidence(study, folder)
        results = folder / root_of(study.name)
        own = Place(study.robot, study.scenario)
        scenario = folder / own.scenario_file(root_of(study.name))
        scenario.parent.mkdir(parents=True)
        damages = [{"link": "forearm_link", "shorten": "1 cm"}]
        scenario.write_text(json.dumps({"damages": damages}))
        for place, learners in places(study).items():
            for learner, lengths in learners.items():
                path = folder / place.history_file(root_of(study.name), learner)
                path.parent.mkdir(parents=True, exist_ok=True)
                pd.concat(map(history, lengths)).to_parquet(path)
        (results / "assignments").mkdir()
        pd.DataFrame({"distance": np.linspace(0, 1, 5760)}).to_parquet(
            results / "assignments" / f"{study.robot}.parquet"
        )
        summary(study).to_csv(results / "summary.csv", index=False)
        if setups:
            table = outcomes(changed(study, campaign={"setups": setups}))
            table.to_csv(folder / "workflow" / "campaign" / "outcomes.csv", index=False)
        (results / "claims.json").write_bytes(written(judge(evidence)))
        return folder

    return make
