"""The design of the multiverse, and the universes that it describes."""

from itertools import combinations, islice

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from recalib.damaged.damage import BaseShift, apply
from recalib.errors import RecalibError, UnfitWorkspace
from recalib.nominal.poses import pose_errors
from replication.campaign import homes
from replication.campaign.design import read_design
from replication.campaign.drawing import design as design_of
from replication.campaign.drawing import draw, moved
from replication.campaign.factors import rows
from replication.campaign.homes import random_home
from replication.campaign.universe import metric, universe, wider, width_units
from replication.campaign.world import rules_in
from replication.config.damages import damages_among
from replication.config.shipped import DESIGN
from replication.config.universes import Factors
from replication.scenarios.plants import nominal_controller, nominal_robot
from tests.conftest import ROOT, changed

FACTORS = list(Factors.model_fields)
SAME = (0.9375, 1.125, 0.9375, 0.75, 0.75, 0.75)  # half-ranges in cm and degrees, over 26.7


@pytest.fixture(scope="module")
def universes(study, design):
    return [universe(study, each) for each in design]


def test_levels_have_equal_shares_and_so_have_their_pairs(study, design):
    table = pd.DataFrame([each.levels for each in design])
    codes = {name: pd.factorize(table[name])[0] for name in FACTORS}
    for factor, its in codes.items():
        shares = np.bincount(its)
        assert len(shares) == len(getattr(study.universes.factors, factor)) >= 2
        assert np.ptp(shares) <= {2: 0, 3: 1, 5: 2}[len(shares)], factor
    for one, other in combinations(FACTORS, 2):
        many = codes[other].max() + 1
        counts = np.bincount(codes[one] * many + codes[other])
        size = many * (codes[one].max() + 1)
        # three and five levels divide no power of two
        most = 0 if size == 4 else 0.9 if "robot" in (one, other) else 0.6
        assert len(counts) == size
        assert np.abs(counts * size / len(design) - 1).max() <= most, (one, other)


def test_no_factor_passes_for_another_nor_for_two(study, design):
    """Not for another even in the setups of the horizon."""
    table = pd.DataFrame([each.levels for each in design])
    two = [name for name in FACTORS if table[name].nunique() == 2]
    signs = {name: 2 * pd.factorize(table[name])[0] - 1 for name in two}
    for triple in combinations(two, 3):
        assert abs(np.mean(np.prod([signs[name] for name in triple], axis=0))) < 0.2, triple
    sought = [each.universe in study.universes.horizons for each in design]
    for one, other in combinations(two, 2):
        assert abs(np.mean((signs[one] * signs[other])[sought])) < 0.5, (one, other)


def test_the_shipped_design_is_drawn_again_byte_by_byte(plan, rules, design):
    job = rules.arguments(plan.study, "design")["setting"]
    sequence = {row.number: row for row in rows(job.plan)}
    for each in design:
        levels = {name: str(level) for name, level in sequence[each.row].levels.items()}
        assert each.levels == levels
    again = list(design)
    for each in design[3::29]:  # all of them take a minute
        again[each.universe] = draw(job, each.universe, sequence[each.row])
    text = pd.DataFrame([each.as_row() for each in again]).to_csv(index=False)
    assert text.encode() == (ROOT / DESIGN).read_bytes()


def test_what_a_robot_refuses_is_replaced_by_the_next_row(plan, rules):
    job = rules.arguments(plan.study, "design")["setting"]
    factors = job.plan.factors.model_copy(update={"home": ("configured",), "assignment": ("any",)})
    few = job.plan.model_copy(update={"count": 2, "factors": factors})
    first = list(islice(rows(few), 4))
    name = first[0].levels["robot"]
    robots = {each.name: each for each in job.robots}
    wide = robots[name].robot.workspace.model_copy(update={"position": (3.0, 3.6, 3.0)})
    robots[name] = changed(robots[name], workspace=wide)
    job = job.model_copy(update={"plan": few, "robots": tuple(robots.values())})
    expected = [row.number for row in first if row.levels["robot"] != name][:2]
    assert [(each["universe"], each["row"]) for each in design_of(job)] == [*enumerate(expected)]


def test_a_design_that_no_robot_serves_says_so(plan, rules):
    job = rules.arguments(plan.study, "design")["setting"]
    strict = job.robots[0].controller.model_copy(update={"greatest_condition": 1.1})
    robots = tuple(each.model_copy(update={"controller": strict}) for each in job.robots)
    factors = job.plan.factors.model_copy(update={"home": ("configured",)})
    few = job.plan.model_copy(update={"count": 1, "factors": factors})
    with pytest.raises(RecalibError, match="only 0 of 1 universes are possible"):
        design_of(job.model_copy(update={"plan": few, "robots": robots}))


def test_a_random_home_is_near_and_one_that_the_controller_accepts(plan, monkeypatch):
    robot = nominal_robot(plan.nominal("ur5"))
    controller, refused = random_home(robot, 0.7, 60, np.random.default_rng(3))
    turns = controller.robot.home - robot.home
    assert refused > 0 and 0 < np.abs(turns).max() <= 0.7
    degrees = np.degrees(controller.robot.home)
    assert np.allclose(degrees, degrees.round())
    assert np.allclose(
        controller.inverse(controller.robot.workspace.centre[None])[0], degrees * np.pi / 180
    )
    monkeypatch.setattr(homes, "CANDIDATES", 3)
    with pytest.raises(UnfitWorkspace, match="refuses all of 3 random homes"):
        random_home(robot, 0.0, 1.1, np.random.default_rng(3))


def test_random_directions_keep_lengths_and_angles():
    shifts = [BaseShift(translation=(0.05, -0.05, 0.04)), BaseShift(rotation=(0.03, -0.05, 0.05))]
    assert moved(shifts[:1], 1.0, None) == (shifts[0],)
    translation, rotation = moved(shifts, 0.5, np.random.default_rng(0))
    assert translation.rotation == rotation.translation == (0, 0, 0)
    length = 0.5 * np.linalg.norm(shifts[0].translation)
    assert np.linalg.norm(translation.translation) == pytest.approx(length, abs=1e-4)
    angles = [
        Rotation.from_euler("xyz", each.rotation).magnitude() for each in (shifts[1], rotation)
    ]
    assert angles[1] == pytest.approx(angles[0], abs=2e-4)


def test_a_universe_has_the_initial_errors_of_its_design(study, design, universes):
    for each, its in list(zip(design, universes, strict=True))[::17]:
        controller = nominal_controller(its.nominal)
        robot = controller.robot
        assert np.allclose(np.degrees(robot.home), each.home_deg)
        desired = robot.workspace.to_poses(robot.workspace.sample(np.random.default_rng(0), 300))
        arm = apply(robot, damages_among(its.scenarios[study.scenario]))
        achieved = arm.forward(controller.inverse(desired))
        errors = pose_errors(robot.workspace, achieved, desired, its.error)
        assert 100 * errors[0].mean() == pytest.approx(each.position_error_cm, rel=0.1)
        assert np.degrees(errors[1].mean()) == pytest.approx(each.orientation_error_deg, rel=0.1)


def test_a_universe_is_what_its_levels_say(study, design, universes):
    for each, its in zip(design, universes, strict=True):
        levels, workspace = each.levels, its.nominal.robot.workspace
        assert (its.nominal.name, workspace.coordinates) == (levels["robot"], levels["coordinates"])
        scale = {"ur10": 1, "ur5": 0.7, "z1": 0.3, "jaco": 0.4, "puma560": 0.5}[levels["robot"]]
        longer = scale * 0.07 if levels["tool"] == "longer" else 0
        assert its.nominal.robot.beyond == pytest.approx(longer)
        initial = its.budget.initial
        assert initial.position_error_cm == pytest.approx(8.3 * scale)
        assert initial.orientation_error_deg == 4.7
        assert its.budget.score == levels["score"]
        lost = [damage.length for damage in each.damage if hasattr(damage, "length")]
        assert sorted(lost) == pytest.approx(sorted(scale * each for each in (0.01, 0.01, 0.04)))
        assert {damage.along for damage in each.damage if hasattr(damage, "along")} == {
            levels["shortening"]
        }
        single = [3, 6, 3] if levels["cells"] == "whole" else [3, 3, 3]
        assert len(its.learners) == 12
        for net in ("supernet", "subnet"):
            small = its.learners[f"improved_small_{net}"]
            assert small == its.learners["improved"].model_copy(update={net: (2, 2, 2)})
        for name, learner in its.learners.items():
            if "small" not in name:
                cells = [3, 3, 3] if learner.maps == "separate" else single
                assert list(learner.supernet) == cells
        trials = its.budget.rounds * its.budget.trials
        assert trials == (16 if levels["effort"] == "rough" else 192)
        wide = levels["ranges"] == "wider"
        assert its.budget.ranges == (wider if wide else lambda same: same)(study.search.ranges)
        assert (its.error, its.order) == (levels["error"], levels["order"])
        assert its.budget.seed == its.seed == each.seed
        assert its.conventions.dimensions == int(levels["dimensions"])


def test_learners_learn_by_the_conventions_of_their_universe(design, universes):
    for each, its in zip(design, universes, strict=True):
        levels = each.levels
        ritter, improved = (rules_in(its, name) for name in ("ritter", "improved"))
        assert (ritter.rate, improved.rate) == (levels["rate"], "linear")
        for rules in (ritter, improved):
            assert (rules.centres, rules.spread) == (levels["centres"], levels["spread"])
            assert rules.metric == its.conventions.metric
            assert rules.dimensions == int(levels["dimensions"])
            half_ranges = levels["widths"] == "half_ranges"
            assert rules.width_units == ((1,) * 6 if half_ranges else pytest.approx(SAME))
            assert rules.initial == (each.seed if levels["initial"] == "random" else None)


def test_wider_ranges_are_twice_as_wide_in_logarithms(study):
    ranges = wider(study.search.ranges)
    assert ranges.initial_width == pytest.approx((0.04, 25))
    assert ranges.final_width == (pytest.approx(0.1**1.5, rel=1e-3), 1)
    assert ranges.initial_rate == (pytest.approx(0.2**1.5, rel=1e-3), 1)
    assert ranges.final_rate == (pytest.approx(0.05**1.5, rel=1e-3), 1)


def test_a_width_in_centimetres_and_degrees_means_as_much_as_one_in_half_ranges(study):
    own = study.robots["ur10"].workspace
    units = width_units("centimetres_degrees", own)
    assert units == pytest.approx(SAME) and np.mean(units[:3]) == pytest.approx(1)
    assert width_units("half_ranges", own) == (1,) * 6


def test_the_first_campaign_is_still_read():
    """Its factors are fewer."""
    path = ROOT / "workflow" / "universes" / "first" / "design.csv"
    first = read_design(path)
    assert len(first) == len(pd.read_csv(path.with_name("outcomes.csv"))) == 128
    assert set(first[0].levels) - {"budget"} < set(FACTORS)


def test_every_universe_has_luck_of_its_own(design):
    assert len({each.seed for each in design}) == len(design)


def test_the_metric_turns_coordinates_into_the_units_of_the_norm(study):
    workspace = study.robots["ur10"].workspace
    metres = metric("metres_radians", workspace)
    assert metric("half_ranges", workspace) == (1,) * 6
    assert metres == pytest.approx((0.25, 0.3, 0.25, *np.radians([20] * 3)))
    assert metric("centimetres_degrees", workspace) == pytest.approx((25, 30, 25, 20, 20, 20))
