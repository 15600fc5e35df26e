"""An error planted in a rule must show: the check of the final errors turns red."""

from unittest import mock

import pandas as pd
import pytest

from recalib.learners import cell_loops
from replication.judgement import check, expect, summarise
from replication.running import write
from replication.scenarios import resolve
from replication.training.train import train
from tests.conftest import changed
from tests.replication.conftest import ALONE, settings_of


@pytest.fixture(scope="module")
def errors(study, tmp_path_factory):
    """Trains both learners on the paper's damage, with a seed; gives the summary's table."""
    folder = tmp_path_factory.mktemp("planted")
    learners = {"improved": (200,), "ritter": (200,)}
    plan = {"scenarios": ("links_encoders",), "learners": learners} | ALONE
    one = changed(study, experiments=plan)
    resolved, settings = folder / "resolved.json", settings_of(study, folder / "outcomes.csv")
    write(resolved, resolve(study, study.robot, ["links_encoders"])[0][0])
    files = [[folder / f"{name}.{kind}" for name in learners] for kind in ("parquet", "npz")]

    def trained(seed: int = study.seed) -> pd.DataFrame:
        seeded = changed(one, seed=seed)
        train(seeded, study.robot, "links_encoders", resolved, settings, *files)
        return summarise(seeded, files[0])

    return trained


def nothing_propagated(cells, waiting, *others, learn=cell_loops.learn):
    """Zeros are propagated in place of increments of Jacobians."""
    learn(cells, waiting, *others)
    cell_loops.Cells(*cells).jacobian_star[:, :, waiting] = 0


def test_the_check_is_green_with_other_seeds_and_red_with_an_error_in_the_rules(study, errors):
    bands = expect(errors())
    assert check(errors(study.seed + 1), bands)["ok"].all()
    with mock.patch.object(cell_loops, "learn", nothing_propagated):
        table = check(errors(), bands)
    assert not table.loc[table["learner"] == "improved", "ok"].all()
