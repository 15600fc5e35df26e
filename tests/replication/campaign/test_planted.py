"""From search to verdict: each contrast finds an effect that was planted, and none that was not."""

from pathlib import Path

import numpy as np
import pytest

from replication.campaign import DOUBLE, TWO_MAPS
from replication.campaign.measuring import of_one
from replication.config import IMPROVED, read_study
from replication.judgement import Verdict
from replication.judgement.claims import claims
from tests.replication.campaign.planted import campaign, valley

SETUPS = 9
PLAN = {"search": {"trials": 320, "runs": 4, "fresh": 20, "doublings": 1}, "campaign": {"runs": 20}}


@pytest.fixture(scope="module")
def study():
    return read_study(Path("config.yaml"), PLAN)


def rates(settings):
    """Fast learning is best, and slows down a little."""
    return valley(settings["initial_rate"], 0.8) + valley(settings["final_rate"], 0.5)


def widths_of_two_maps(name, settings, iterations, effect):
    """The position map wants g_k narrower than g_kl by the effect, the orientation map wider."""
    found = []
    for kind, sign in (("position", 1), ("orientation", -1)):
        narrow = 0.4 * np.exp(-sign * effect / 2), 0.4 * np.exp(sign * effect / 2)
        logs = np.log(0.2) + rates(settings) + valley(settings["initial_width"], 2.0, 0.02)
        for net, optimum in zip(("g_k", "g_kl"), narrow, strict=True):
            logs = logs + valley(settings[f"{kind}_{net}"], optimum, 0.1)
        found.append(logs)
    return np.stack(found, axis=-1)


def one_map(name, settings, iterations, effect):
    """Positions want g_k narrower than orientations do, by the effect."""
    if name == IMPROVED:  # how long to go on, no part of this world
        return np.zeros((len(settings["initial_rate"]), 2))
    base = np.log(0.3) + rates(settings) + valley(settings["pose_g_kl"], 0.4)
    optima = 0.4 * np.exp(-effect / 2), 0.4 * np.exp(effect / 2)
    return np.stack(
        [base + valley(settings["pose_g_k"], optimum, 0.1) for optimum in optima], axis=-1
    )


def by_name(worse):
    """All variants have one optimum; some leave more by the effect."""

    def surface(name, settings, iterations, effect):
        logs = np.log(0.05) + rates(settings) + valley(settings["initial_width"], 3.0)
        logs = logs + worse.get(name, 0.0) * effect
        return np.stack([logs, logs - 0.1], axis=-1)

    return surface


def learning(name, settings, iterations, effect):
    """Ritter's map needs exp(effect) times the iterations of the improved system."""
    times = 0.0 if name == IMPROVED else effect
    logs = -0.5 * (np.log(iterations / 200) - times) + np.log(0.05) + rates(settings)
    return np.stack([logs, logs - 0.1], axis=-1)


ORDERS = [f"two_maps_for_{{0}}{order}" for order in ("_paper", "_reverse")]


def names_of(kind):
    return [TWO_MAPS, *(name.format(kind) for name in ORDERS)]


POSITION, ORIENTATION = names_of("position"), names_of("orientation")
WIDE = [TWO_MAPS, "two_maps_for_position", "two_maps_for_position_wide"]
ONE = [IMPROVED, DOUBLE, "one_map_for_position", "one_map_for_orientation"]
THETA = [IMPROVED, "improved_theta_values"]
CELLS = [f"small_{net}{kind}" for kind in ("", "_for_position") for net in ("supernet", "subnet")]
DRASTIC = [IMPROVED, "improved_values", "improved_drastic", "improved_values_drastic"]
without = by_name({"improved_theta_values": 1})
small = by_name({"small_subnet": 1, "small_subnet_for_position": 1})
drastic = by_name({"improved_values": 1, "improved_values_drastic": 0.5})
alike = by_name({"improved_values": 1, "improved_values_drastic": 1})
SAME, OFTEN = np.zeros(SETUPS), np.full(SETUPS, 1.0)
SIGNS = np.where(np.arange(SETUPS) % 2, 0.6, -0.6)
VERDICTS = Verdict.SUPPORTED, Verdict.CONTRADICTED, Verdict.NO_EFFECT, Verdict.DEPENDS
YES, NO, NONE, DEPENDS = VERDICTS
WORLDS = {
    "a narrow g_k for positions": ("widths-position", POSITION, widths_of_two_maps, 2 * OFTEN, YES),
    "equal widths for positions": ("widths-position", POSITION, widths_of_two_maps, SAME, NONE),
    "a wide g_k for positions": ("widths-position", POSITION, widths_of_two_maps, -2 * OFTEN, NO),
    "equal widths for turns": ("widths-orientation", ORIENTATION, widths_of_two_maps, SAME, NONE),
    "a wide g_k for turns": ("widths-orientation", ORIENTATION, widths_of_two_maps, 2 * OFTEN, YES),
    "wide neighbourhoods hurt": ("large-neighbourhoods", WIDE, widths_of_two_maps, OFTEN, YES),
    "one map has two optima": ("no-good-solution", ONE, one_map, 2.5 * OFTEN, YES),
    "one map has one optimum": ("no-good-solution", ONE, one_map, SAME, NONE),
    "increments of theta help": ("theta-increments", THETA, without, 0.25 * OFTEN, YES),
    "increments of theta do nothing": ("theta-increments", THETA, without, SAME, NONE),
    "increments of theta hurt": ("theta-increments", THETA, without, -0.25 * OFTEN, NO),
    "increments help here, hurt there": ("theta-increments", THETA, without, SIGNS, DEPENDS),
    "positions spare the supernet": ("cells-position", CELLS, small, 0.3 * OFTEN, YES),
    "cells in either net do the same": ("cells-position", CELLS, small, SAME, NONE),
    "positions spare the subnet": ("cells-position", CELLS, small, -0.3 * OFTEN, NO),
    "a drastic change takes the advantage": ("not-drastic", DRASTIC, drastic, 0.8 * OFTEN, YES),
    "a drastic change changes nothing": ("not-drastic", DRASTIC, alike, 0.8 * OFTEN, NONE),
    "a drastic change helps": ("not-drastic", DRASTIC, drastic, -0.8 * OFTEN, NO),
    "Ritter's map needs long": ("long", [IMPROVED, DOUBLE], learning, np.log(90) * OFTEN, YES),
    "Ritter's map is nearly as fast": ("long", [IMPROVED, DOUBLE], learning, 1.5 * OFTEN, NO),
}
FAST = "positions spare the supernet", "increments of theta help", "Ritter's map needs long"


class Table:
    """What a claim reads."""

    def __init__(self, table):
        self._table = table

    def outcomes(self):
        return self._table


@pytest.mark.parametrize(
    "world",
    [pytest.param(world, marks=() if world in FAST else pytest.mark.slow) for world in WORLDS],
)
def test_what_was_planted_is_found(study, world, monkeypatch):
    monkeypatch.setattr("replication.judgement.claims.claim.FEWEST", SETUPS)  # of a real campaign
    name, names, surface, effects, verdict = WORLDS[world]
    random = np.random.default_rng(len(world))
    claim = next(claim for claim in claims(study) if claim.id == name)
    table = campaign(study, names, surface, effects + 0.03 * random.normal(size=SETUPS), 1)
    assert claim.comparison.verdict(claim.values(Table(table)).model()) is verdict


def test_an_error_that_is_bought_with_the_other_one_counts_for_more():
    shares = np.array([[0.1, 0.1], [0.1, 0.2], [0.1, 0.4]])
    score = of_one("position", {"position_share": 0.3, "orientation_share": 0.2})
    assert score(shares) == pytest.approx([0.1, 0.1, 0.1 * 2**8])
