"""What is measured in a replicate of a setup, and with which luck, in tiny setups."""

import zlib
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from replication.campaign import horizon, measuring
from replication.campaign.measuring import measured, width_order
from replication.campaign.reference import reference_universe
from replication.campaign.universe import Universe, universe
from replication.campaign.world import World, rules_in
from replication.config.switches import SWITCHES
from replication.judgement.claims import CLAIMS
from replication.judgement.measured import ERRORS, KINDS, RIGID
from replication.training import search
from replication.training.search import NETS
from replication.training.settings import rules_of
from replication.training.trainings import budget as budget_of
from replication.training.trials import Search

ITERATIONS = 4


def test_of_an_error_that_is_none_at_first_in_any_seed_nothing_is_asked():
    first, last = [[8.0, 2.0], [8.0, 0.0]], [[4.0, 1.0], [1.0, 1.0]]
    errors = np.stack([first, last], axis=1)  # (seed, measurement, kind)
    assert measuring._remaining(errors) == pytest.approx([0.25])


def made_small(its: Universe, **update) -> Universe:
    """With searches of two trials and trainings of a few iterations."""
    budget = its.budget.model_copy(update={"rounds": 1, "trials": 2, "seeds": 1})
    learners = {
        name: learner.model_copy(update={"iterations": ITERATIONS})
        for name, learner in its.learners.items()
    }
    less = {"budget": budget, "learners": learners, "tests": 3, "seeds": 2, "rungs": (4, 8, 16)}
    return its.model_copy(update=less | update)


@pytest.fixture(scope="module")
def each(study, design) -> Universe:
    """A small one in which each map has the cells of the nets."""
    first = next(its for its in design if its.levels["cells"] == "each")
    return made_small(universe(study, first))


def test_a_search_follows_from_the_seed_of_its_budget_and_a_training_from_that_of_its_setup(
    each, roots
):
    its = World(each.model_copy(update={"seed": 5}), 1)
    its.tuned("ritter", ITERATIONS)
    names = (each.budget.seed, f"search for ritter_{ITERATIONS}, replicate 1"), (5, "replicate 1")
    # no learner's name is among the latter: those that are compared see the same poses
    assert {root[:2] for root in roots} == {(seed, zlib.crc32(of.encode())) for seed, of in names}


def test_two_maps_of_equal_widths_are_one_map_bit_for_bit(each):
    """Before any further trial: so the larger search has no disadvantage, and no advantage."""
    its, seen = World(each, 0), []

    def further(self, start):
        seen.append((self, pd.DataFrame([dict(start)])))
        return seen[-1][1]

    for pair in (("ritter", "ritter_separate_maps"), ("improved_single_map", "improved")):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(Search, "further", further)
            one, two = measuring.one_and_two_maps(its, *pair, ITERATIONS)
        assert np.array_equal(one, two) and one.shape == (each.seeds, 2)
        (alone, _), (both, start) = seen[-2:]
        assert alone.poses.name == both.poses.name
        for kind in ("position", "orientation"):
            for net in search.NETS:
                assert (start[f"{kind}/{net}"] == start[f"pose/{net}"]).all()


def test_g_k_and_g_kl_correlate_with_errors_as_the_paper_has_it():
    """Position wants a narrow g_k and a wide g_kl, orientation the reverse."""
    ratios = np.linspace(0.2, 5, 9)
    table = pd.DataFrame({"round": 1, "position_error_cm": ratios, "position/g_k": ratios})
    table = table.assign(**{"orientation_error_deg": ratios, "orientation/g_kl": ratios})
    table = table.assign(**{"position/g_kl": 1.0, "orientation/g_k": 1.0})
    assert width_order(table) == pytest.approx({"order_position": 1, "order_orientation": 1})
    swapped = {"position/g_k": "position/g_kl", "position/g_kl": "position/g_k"}
    swapped |= {
        f"orientation/{a}": f"orientation/{b}" for a, b in (("g_k", "g_kl"), ("g_kl", "g_k"))
    }
    found = width_order(table.rename(columns=swapped))
    assert found == pytest.approx({"order_position": -1, "order_orientation": -1})
    later = table.rename(columns=swapped).assign(round=2)
    both = pd.concat([table, later])
    assert width_order(both) == width_order(table), "later rounds surround what was good before"


REACHED = [
    (None, [8, 16], 4.0, 1),  # nowhere: at least the longest rung
    (1, [8, 4], 1.0, -1),  # in the shortest: at most that
    (4, [8, 4], 1.0, -1),
    (8, [8, 4], 2**0.5, 0),
    (16, [8, 16], 2**1.5, 0),
]


@pytest.mark.parametrize(("reaches", "tried", "factor", "bound"), REACHED)
def test_the_horizon_is_sought_up_to_the_first_rung_that_reaches(
    each, monkeypatch, reaches, tried, factor, bound
):
    seen = []

    def tuned(_, name, iterations):
        if name == "improved":
            return np.array([[1.0, 1.0]])
        seen.append(iterations)
        missed = reaches is None or iterations < reaches
        return np.array([[0.5, 2.0 if missed else 0.5]])

    monkeypatch.setattr(World, "tuned", tuned)
    found = horizon._factor(World(each, 0))
    assert found == {"factor": pytest.approx(factor), "bound": bound}
    assert seen == tried


def test_the_direction_in_which_the_robot_is_moved_reaches_no_number_of_the_factor(study, design):
    """The negative control: byte by byte, in a tiny setup."""
    first = next(its for its in design if its.levels["displacement"] == "configured")
    other = next(its for its in design if its.levels["displacement"] == "random")
    levels = first.levels | {"displacement": "random"}
    moved = first.model_copy(update={"moved": other.moved, "levels": levels})
    assert first.moved != moved.moved
    less = {"replicates": 1, "rungs": (4, 8)}
    ours, theirs = (
        horizon.horizon(made_small(universe(study, it), **less)) for it in (first, moved)
    )
    assert repr(ours) == repr(theirs)
    assert universe(study, first).scenarios != universe(study, moved).scenarios


def test_the_reference_study_is_a_setup_with_the_first_levels_and_its_own_seed(study, plan, robot):
    resolved = plan.resolved("links")
    its = reference_universe(study, resolved)
    assert its.seed == its.budget.seed == study.seed and its.number == -1
    assert its.scenarios[its.own] == tuple(resolved.damages)
    own = plan.nominal(study.robot).robot
    assert its.nominal.robot.model_copy(update={"home": own.home}) == own
    assert [*its.nominal.robot.home.values()] == pytest.approx([*own.home.values()])
    for name in ("improved", "ritter"):
        rules = rules_of(study.learners[name])
        assert rules_in(its, name) == replace(rules, rate=rules.law_of_rate)
    assert (its.error, its.order, its.budget.rounds) == ("norm", "random", study.search.rounds)
    budget = budget_of(study).model_copy(update={"seed": study.seed})
    assert its.budget == budget


class Planted(World):
    """A replicate in which each training ends with errors of its own, which are known."""

    def __init__(self):
        improved = SimpleNamespace(iterations=ITERATIONS)
        self.universe = SimpleNamespace(
            learners={"improved": improved},
            rough_trials=2,
            seed=7,
            scenarios=("rotation", "translation"),
        )
        self.replicate, self.sampled = 3, []
        sample = SimpleNamespace(sample=lambda rng, poses: self.sampled.append(rng.random()))
        self.controller = SimpleNamespace(robot=SimpleNamespace(workspace=sample))

    def arm(self, scenario):
        return scenario

    def search(self, learner, iterations, like="", fixed=None, kind=None):
        def trials(of):
            wide, narrow = ([f"{its}/{net}" for its in ("pose", *KINDS)] for net in NETS)
            same = {name: [3.0, 1, 2] for name in ("score", *ERRORS, *wide)}
            return pd.DataFrame({"round": 1, "of": of} | same | dict.fromkeys(narrow, 1.0))

        said = f"{learner} {iterations} {like} {fixed or {}}"
        return SimpleNamespace(
            all_rounds=lambda: trials(said),
            further=lambda start: trials(f"{said} from {start['of']}"),
        )

    def train(self, learner, iterations, trials, scenario="", kind=None):
        last = self.last(learner, iterations, trials["of"].iloc[0], len(trials), scenario)
        return np.stack([FIRST, np.outer([1, 4], last)], axis=1)

    @staticmethod
    def last(*training) -> np.ndarray:
        """(2,) of the first seed; of the second, four times that."""
        return np.random.default_rng(zlib.crc32(repr(training).encode())).uniform(0.1, 1, 2)


FIRST = np.array([[10.0, 20], [30, 60]])  # (seed, 2), of all trainings
HUNDRED = np.arange(101)


def test_every_number_of_a_replicate_is_what_it_says(monkeypatch):
    def coupled(controller, arm, desired):
        return pd.DataFrame({"orientation": {"rotation": 2, "translation": 1}[arm] * HUNDRED})

    monkeypatch.setattr(measuring, "coupling", coupled)
    world = Planted()

    def last(name, iterations=4, of="", like="", fixed="{}", count=3, scenario=""):
        return world.last(
            name, iterations, of or f"{name} {iterations} {like} {fixed}", count, scenario
        )

    def two_over_one(single, separate, iterations):
        start = f"{single} {iterations}  {{}}"
        one = last(single, iterations, f"{start} from {start}")
        two = last(separate, iterations, f"{separate} {iterations} {single} {{}} from {start}")
        return np.sqrt(np.prod(two / one))

    def remaining(*training, **how):
        return 2 * last(*training, **how) / np.sqrt(FIRST.prod(axis=0))

    usual = "improved 4  {}"
    small = last("improved_small_supernet") / last("improved_small_subnet")
    wide = last("improved", fixed="{'position/g_k': 2.0}")
    radial = [last(name, like=f"radial {name}") for name in ("improved", "improved_theta_values")]
    expected = {
        "initial_position_error_cm": 20,
        "initial_orientation_error_deg": 40,
        "final_position_error_cm": 2.5 * last("improved")[0],
        "final_orientation_error_deg": 2.5 * last("improved")[1],
        "remaining": remaining("improved").max(),
        "remaining_ritter": remaining("ritter").min(),
        "remaining_rough": remaining("improved", count=2).max(),
        "maps_improved": two_over_one("improved_single_map", "improved", 4),
        "maps_ritter": two_over_one("ritter", "ritter_separate_maps", 4),
        "maps_ritter_late": two_over_one("ritter", "ritter_separate_maps", 1000),
        "order_position": 1,
        "order_orientation": -1,
        "cells_position": small[0],
        "cells_orientation": 1 / small[1],
        "narrow": last("improved")[0] / wide[0],
        "radial": np.sqrt(np.prod(radial[0] / radial[1])),
        "rigid": max(remaining("improved", of=usual, scenario=each).max() for each in RIGID),
        "intact": 60,
        "coupling": 2 * 95,
    }
    for its in SWITCHES[1:]:
        ours, ritters = last("improved") / last(its.without), last(its.added) / last("ritter")
        expected[f"{its.key}_improved"] = np.sqrt(np.prod(ours))
        expected[f"{its.key}_ritter"] = np.sqrt(np.prod(ritters))
    assert measured(world) == pytest.approx(expected)
    columns = {its.column for claim in CLAIMS for its in claim.across.values()}
    assert columns - {"factor"} <= {*expected}, "what the claims ask for"
    assert world.sampled == [np.random.default_rng([7, 3]).random()]
    assert world.tuned("ritter", 8) == pytest.approx(np.outer([1, 4], last("ritter", 8)))
