"""An error planted in a rule must show: the check of the final errors turns red."""

from unittest import mock

import numpy as np
import pandas as pd
import pytest

from recalib.learners import kernels
from recalib.learners import rules as learning_rules
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


@pytest.fixture(scope="module")
def bands(errors):
    return expect(errors())


def random_winners():
    """Other cells than the winners teach their neighbours."""
    learn, rng = kernels.learn, np.random.default_rng(0)

    def mistaken(cells, waiting, increments, winners, *others):
        learn(cells, waiting, increments, rng.integers(27, size=winners.shape), *others)

    return mock.patch.object(kernels, "learn", mistaken)


def nothing_propagated(*names):
    """Zeros are propagated in place of these, of `kernels.Cells`."""
    learn = kernels.learn

    def mistaken(cells, waiting, *others):
        learn(cells, waiting, *others)
        for name in names:
            getattr(kernels.Cells(*cells), name)[:, :, waiting] = 0

    return mock.patch.object(kernels, "learn", mistaken)


PLANTED = {
    "Jacobian increment off": lambda: nothing_propagated("jacobian_star"),
    "winner at random": random_winners,
    # dt proportional to width^n d(width) instead of width^-n: most of the time at the large widths
    "equal visits inverted": lambda: mock.patch.object(
        learning_rules, "equal_visits", lambda dimensions, _: 1.0 + dimensions
    ),
}


def test_without_an_error_the_check_is_green_with_other_seeds_too(study, errors, bands):
    assert check(errors(), bands)["ok"].all()
    assert check(errors(study.seed + 1), bands)["ok"].all()


def test_an_error_planted_in_ritters_rules_turns_the_check_red(errors, bands):
    with nothing_propagated("theta_star", "jacobian_star"):
        table = check(errors(), bands)
    assert not table.loc[table["learner"] == "ritter", "ok"].any()


@pytest.mark.parametrize("error", PLANTED)
def test_a_planted_error_turns_the_check_red(error, errors, bands):
    with PLANTED[error]():
        table = check(errors(), bands)
    assert not table.loc[table["learner"] == "improved", "ok"].all()
