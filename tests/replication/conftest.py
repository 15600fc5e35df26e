"""A scenario in which everything counts, and settings for every learner."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from recalib import EncoderShift, LinkShortening
from replication.config import Study
from replication.scenarios import Resolved
from replication.training import Space, rules_of, trained
from tests.conftest import changed

# A plan of experiments on the study's own robot, with no learners but those that it names.
ALONE = {"own": {}, "robots": (), "switches": False}


@pytest.fixture(scope="session")
def uneven(plan) -> Resolved:
    """The study's robot with a link short, an encoder shifted, and noise of its own."""
    noise = plan.study.scenarios["noise"][-1]
    damages = LinkShortening("forearm_link", 0.04), EncoderShift("wrist_1_joint", -0.06), noise
    return changed(plan.resolved("intact"), scenario="uneven", damages=damages)


def settings_of(study: Study, path: Path) -> list[Path]:
    """A table as the campaign's: of all that the study trains, near what a search finds."""
    rows = []
    for number, (name, iterations) in enumerate(sorted(trained(study))):
        space = Space(rules_of(study.every_learner[name]), study.search.ranges)
        row = dict.fromkeys(space.columns, 0.6)
        row |= {"initial_width": 4.6 + 0.01 * number, "initial_rate": 0.99, "final_rate": 0.72}
        keys = {"setup": 0, "replicate": 0, "variant": name, "iterations": iterations}
        rows.append(keys | row)
    table = pd.DataFrame(rows)
    others = [table.assign(**{key: 1}, initial_width=np.nan) for key in ("setup", "replicate")]
    pd.concat([table, *others]).to_csv(path, index=False)
    return [path]


@pytest.fixture(scope="session")
def settings(study, tmp_path_factory) -> list[Path]:
    """Settings of the shipped study."""
    return settings_of(study, tmp_path_factory.mktemp("settings") / "outcomes.csv")
