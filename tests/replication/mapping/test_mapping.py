"""The mapping from desired poses to commands, and the quantisation of its domain."""

import numpy as np
import pandas as pd
import pytest

from recalib import BaseShift, EncoderShift, LinkShortening, Plant, apply
from replication.judgement.claims import integral_ratios
from replication.mapping import (
    RATES,
    WIDTHS,
    are_same,
    ball,
    grown,
    joint_solutions,
    kohonen,
    mapping_jacobians,
    propagation_errors,
    true_commands,
)
from replication.mapping.quantisation import quantisation
from replication.mapping.solutions import solutions
from replication.mapping.true_mapping import coupling
from replication.mapping.visits import visits


@pytest.fixture(scope="module")
def desired():
    return np.random.default_rng(4).uniform(-1, 1, (50, 6))


def test_the_true_commands_take_the_damaged_arm_to_the_desired_poses(controller, damaged, desired):
    commands = true_commands(controller, damaged, desired)
    achieved = Plant(controller, damaged).execute(commands[None]).achieved[0]
    assert np.allclose(achieved, desired, atol=1e-9)
    assert np.abs(commands - desired).max() > 0.1
    assert np.isnan(true_commands(controller, damaged, np.array([[20.0, 0, 0, 0, 0, 0]]))).all()


def test_the_intact_mapping_is_the_identity_and_the_jacobian_the_slope_of_the_true_commands(
    controller, robot, damaged, desired
):
    intact = apply(robot, [])
    assert np.allclose(true_commands(controller, intact, desired), desired, atol=1e-9)
    assert np.allclose(mapping_jacobians(controller, intact, desired), np.eye(6), atol=1e-6)
    jacobians = mapping_jacobians(controller, damaged, desired)
    step = 1e-4 * np.array([1, -2, 1, 2, -1, 1])
    ends = [true_commands(controller, damaged, desired + sign * step) for sign in (-1, 1)]
    assert np.allclose(jacobians @ (2 * step), ends[1] - ends[0], atol=1e-7)


def test_a_rigid_shift_does_not_couple_and_a_link_does(controller, robot, damaged):
    desired = np.random.default_rng(0).uniform(-1, 1, (10, 6))
    moved = coupling(controller, apply(robot, [BaseShift((0.05, 0, 0), (0, 0, 0.05))]), desired)
    assert moved.to_numpy().max() < 1e-6
    assert coupling(controller, damaged, desired).to_numpy().max() > 0.005


def test_a_pose_has_many_joint_solutions_and_one_command(controller, damaged, desired):
    table = solutions(controller, damaged, desired[:5], np.random.default_rng(0))
    assert (table["commands"] == 1).all()
    assert table["joint_solutions"].max() == 8, "as a wrist, an elbow and a shoulder give"


def test_joint_solutions_are_counted_once_and_all_reach_the_pose(controller, robot, damaged):
    pose = robot.workspace.to_poses(np.zeros((1, 6)))
    own = controller.solve(pose).angles
    others = np.random.default_rng(1).uniform(-3, 3, (60, 6))
    starts = np.vstack([own, own + 2 * np.pi, own, others])
    limits = np.full(6, -9.0), np.full(6, 9.0)
    found = joint_solutions(damaged, pose[0], starts, limits)
    assert np.allclose(damaged.forward(found), pose, atol=1e-9)
    apart = are_same(found[:, None], found[None])
    assert (apart == np.eye(len(found), dtype=bool)).all() and len(found) > 1
    narrow = found[0] - 1e-3, found[0] + 1e-3
    assert len(joint_solutions(damaged, pose[0], starts, narrow)) == 1


def test_the_ball_is_uniform():
    points = ball(np.random.default_rng(0), 20_000, 3, 2.0)
    radii = np.linalg.norm(points, axis=1)
    assert radii.max() <= 2.0 and np.mean(radii < 1.0) == pytest.approx(1 / 8, abs=0.01)
    assert np.allclose(points.mean(axis=0), 0, atol=0.03)


OFFSETS = ball(np.random.default_rng(1), 4000, 6, 0.5)
CENTRE = np.full(6, 0.2)
MOMENT = np.square(OFFSETS).sum(axis=1).mean()  # |w - c|^2 in the ball, on average


def test_the_integrals_of_section_5_for_mappings_known_by_heart():
    identity, shifted, constant = (lambda w: w), (lambda w: w + 0.3), (lambda w: 0 * w + 0.7)
    found = propagation_errors(identity, shifted, CENTRE, OFFSETS)
    assert found["classic"] == pytest.approx(MOMENT)
    assert found["updated"] == pytest.approx(0, abs=1e-20)
    found = propagation_errors(identity, constant, CENTRE, OFFSETS)
    assert found["classic"] == pytest.approx(0, abs=1e-20)
    assert found["updated"] == pytest.approx(MOMENT)


def test_the_condition_of_section_5_takes_the_best_constants_and_not_those_of_the_rules():
    """Affine f and f', with M and N for Jacobians: spreads about the mean of the ball's points."""
    rng = np.random.default_rng(4)
    m, n = rng.normal(size=(2, 6, 6))
    found = propagation_errors(lambda w: w @ m.T, lambda w: w @ n.T + 5, CENTRE, OFFSETS)
    for name, matrix in (("to_constant", n), ("to_original", n - m)):
        assert found[name] == pytest.approx(np.trace(matrix @ np.cov(OFFSETS.T, ddof=0) @ matrix.T))
    at_centre = OFFSETS.mean(axis=0)  # by how much the mean is not the value at the centre
    for least, rule, matrix in (("to_constant", "classic", n), ("to_original", "updated", n - m)):
        gap = np.square(matrix @ at_centre).sum()
        assert found[rule] == pytest.approx(found[least] + gap, rel=1e-10) and gap > 0


def test_the_condition_of_jacobians_sums_over_all_that_they_hold():
    """f' has the Jacobian c w_0 in two of its elements, f half of that: a known spread of w_0."""

    def jacobian(c):
        return lambda w: np.stack([c * w[:, :1] * [1, 0], c * w[:, :1] * [0, 1]], axis=1)

    spread = OFFSETS[:, 0].var()
    found = propagation_errors(jacobian(1.0), jacobian(2.0), CENTRE, OFFSETS)
    assert found["to_constant"] == pytest.approx(2 * 4 * spread)
    assert found["to_original"] == pytest.approx(2 * spread)


def test_a_turn_beyond_60_degrees_is_nearer_to_a_constant():
    def turned(angle):
        c, s = np.cos(angle), np.sin(angle)
        matrix = np.kron(np.eye(3), [[c, -s], [s, c]])
        return lambda w: w @ matrix.T

    for angle, better in ((59, True), (61, False)):
        found = propagation_errors(lambda w: w, turned(np.radians(angle)), np.zeros(6), OFFSETS)
        assert (found["updated"] < found["classic"]) == better
        assert (found["to_original"] < found["to_constant"]) == better


def test_visits_agree_with_the_formula_in_the_middle_and_halve_on_a_face():
    table = visits(2).query("width == 0.2 and distance in (0, 1)")
    assert table["ratio"].tolist() == pytest.approx([0.5, 1.0], abs=4 * table["error"].max())


def test_links_are_shortened_by_what_the_paper_says_at_most():
    def damages(short, shifted):
        return [LinkShortening("forearm_link", short), EncoderShift("elbow_joint", shifted)]

    assert grown(damages(0.04, 0.1), 0.5) == damages(0.02, 0.05)
    assert grown(damages(0.04, 0.1), 4) == damages(0.04, 0.4)


def test_a_scale_with_a_ball_that_cannot_be_commanded_is_left_out():
    table = pd.DataFrame({"kind": "theta", "start": "intact", "scale": [1, 1, 2, 2]})
    table = table.assign(classic=2.0, updated=[1.0, 3.0, 1.0, np.nan])
    assert integral_ratios(table).to_dict() == {("theta", "intact", 1): 1.0}


def test_the_kohonen_rule_agrees_with_itself_written_out_cell_by_cell():
    rng = np.random.default_rng(1)
    starts, poses = rng.uniform(-1, 1, (2, 6, 3)), rng.uniform(-1, 1, (2, 30, 3))
    found = kohonen(starts, poses, (3, 2))
    places = [np.array([i, j]) for i in range(3) for j in range(2)]
    for run in range(2):
        w = starts[run].copy()
        for t, u in enumerate(poses[run]):
            winner = int(np.argmin([np.linalg.norm(u - each) for each in w]))
            width = WIDTHS[0] * (WIDTHS[1] / WIDTHS[0]) ** (t / 30)
            rate = RATES[0] * (RATES[1] / RATES[0]) ** (t / 30)
            for i in range(6):
                d = np.linalg.norm(places[i] - places[winner])
                w[i] = w[i] + rate * np.exp(-(d**2) / (2 * width**2)) * (u - w[i])
        assert np.allclose(found[run], w, rtol=0, atol=1e-12)


@pytest.fixture(scope="module")
def line():
    """Two cells on a line, for which all that is known: s / sqrt(3) for a box of half-width s."""
    return quantisation(7, shape=(2,), iterations=(2, 2000), seeds=4)


def test_every_placement_of_two_cells_on_a_line_is_as_good_as_calculated(line):
    assert line.columns.tolist() == ["placement", "seed", "distance"]
    by_placement = line.groupby("placement", sort=False)["distance"]
    names = ["boxes", "faces", "kohonen_2", "kohonen_2000", "kmeans"]
    assert by_placement.size().to_dict() == dict.fromkeys(names, 4)
    best = 0.5 / np.sqrt(3)
    mean = by_placement.mean()
    assert mean["boxes"] == pytest.approx(best, rel=0.01)
    assert mean["faces"] == pytest.approx(2 * best, rel=0.01)
    assert mean["kmeans"] == pytest.approx(best, rel=0.01)
    assert mean["kohonen_2000"] == pytest.approx(best, rel=0.05)
    assert mean["kohonen_2"] > 1.1 * best, "two poses cannot place two cells"
