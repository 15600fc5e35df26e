"""An error planted in a rule must show: the check of the final errors turns red."""

from unittest import mock

import numpy as np
import pandas as pd
import pytest

from recalib.damaged.damage import EncoderShift, LinkShortening, apply
from recalib.damaged.plant import Plant
from recalib.learners import kernels
from recalib.learners import rules as learning_rules
from replication.judgement.checks import check
from replication.training.poses import Stream, train_for_results
from replication.training.settings import build_tuned
from replication.training.trainings import rules, training
from replication.training.trainings import seeds as seeds_of
from tests.conftest import ROOT


def final_errors(study, controller, learner="improved"):
    """The rows of the check for one learner on the paper's damage, trained here and now."""
    damages = [
        LinkShortening("forearm_link", 0.01),
        LinkShortening("wrist_1_link", 0.01),
        LinkShortening("wrist_2_link", 0.04),
        EncoderShift("shoulder_pan_joint", np.radians(4)),
        EncoderShift("shoulder_lift_joint", np.radians(-4)),
        EncoderShift("wrist_3_joint", np.radians(3)),
    ]
    settings = rules(study, learner)
    seeds = np.arange(seeds_of(study, learner))  # those of the bands
    searches = 1 + seeds // study.training.seeds
    sample = ROOT / "workflow" / "search" / f"{training(study, learner)}.csv"
    counts = settings.iterations, study.training.tests
    history = train_for_results(
        Plant(controller, apply(controller.robot, damages)),
        build_tuned(settings, sample, searches),
        Stream.SCENARIO.draw(study.seed, seeds, *counts, scenario="links_encoders"),
        [settings.iterations],
    )
    summary = pd.DataFrame(
        {
            "scenario": ["links_encoders"],
            "learner": [learner],
            "final_position_error_cm": 100 * history.position[:, -1, 0].mean(),
            "final_orientation_error_deg": np.degrees(history.orientation[:, -1, 0]).mean(),
        }
    )
    expected = pd.read_csv(ROOT / study.expected).query(
        "scenario == 'links_encoders' and learner == @learner"
    )
    return check(summary, expected)


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


@pytest.mark.parametrize("learner", ["improved", "ritter_200"])
def test_without_an_error_the_check_is_green(study, controller, learner):
    assert final_errors(study, controller, learner)["ok"].all()


def test_an_error_planted_in_ritters_rules_turns_the_check_red(study, controller):
    with nothing_propagated("theta_star", "jacobian_star"):
        assert not final_errors(study, controller, "ritter_200")["ok"].any()


@pytest.mark.parametrize("error", PLANTED)
def test_a_planted_error_turns_the_check_red(study, controller, error):
    with PLANTED[error]():
        assert not final_errors(study, controller)["ok"].all()
