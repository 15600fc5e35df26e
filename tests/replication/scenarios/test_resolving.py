"""Scenarios as resolved, and the assignments of the paper's damage."""

import numpy as np
import pandas as pd
import pytest

from recalib import (
    EncoderShift,
    LinkShortening,
    Noise,
    Outliers,
    Repeatability,
    apply,
    orientation_error,
    position_error,
)
from recalib.numerics import generator
from replication.config import PaperDamage, Published
from replication.judgement import Evidence, NotMeasured
from replication.running import write
from replication.scenarios import Resolved, Ways, assign, compare, resolve
from replication.training import places, write_scenarios
from tests.conftest import changed


@pytest.fixture(scope="module")
def few(study):
    scenarios = "intact", "links", "encoders", "links_encoders"
    plan = {"scenarios": scenarios, "robots": ("z1",)}
    damage = {"shorten": (0.04,), "shift": (0.07,), "poses": 10}
    return changed(study, experiments=plan, paper_damage=damage, name="few")


@pytest.fixture(scope="module")
def written(few, tmp_path_factory):
    folder = tmp_path_factory.mktemp("scenarios")
    files = {place: folder / place.scenario_file("results/studies/few") for place in places(few)}
    table = write_scenarios(few, [*files.values()])
    write(folder / "results/studies/few/assignments/ur10.parquet", table)
    return folder, files


def test_each_place_has_its_damages_by_one_assignment(written):
    _, files = written
    links, encoders, both, other = (
        Resolved.read(path) for place, path in files.items() if place.scenario != "intact"
    )
    assert [type(damage) for damage in both.damages] == [LinkShortening, EncoderShift]
    assert both.damages == links.damages + encoders.damages
    assert (other.robot, other.scenario) == ("z1", "links_encoders")
    assert other.damages[0].link.startswith("link0"), "links of its own"


def test_the_paper_s_damage_is_the_assignment_nearest_to_the_published_errors(few, written):
    folder, _ = written
    evidence = Evidence(few, folder)
    table = evidence.assignments()
    assert len(table) == 4 * 12  # links, and encoders with a sign each
    nearest = table.loc[table["distance"].idxmin()]
    scenario = evidence.scenario()
    # over other poses: ten of them
    assert scenario["initial_position_error_cm"] == pytest.approx(nearest.iloc[0], rel=0.3)
    assert scenario["initial_orientation_error_deg"] == pytest.approx(nearest.iloc[1], rel=0.3)


def test_initial_errors_are_means_over_the_workspace(study, robot, controller):
    damages = EncoderShift("shoulder_pan_joint", 0.1), EncoderShift("wrist_3_joint", 0.1)
    mine = changed(study, scenarios=study.scenarios | {"mine": damages})
    (resolved,), _ = resolve(mine, "ur10", ["mine"])
    desired = robot.workspace.to_poses(robot.workspace.sample(generator(1), 1000))
    poses = apply(robot, damages).forward(controller.inverse(desired)), desired
    found = resolved.initial_position_error_cm, resolved.initial_orientation_error_deg
    means = 100 * position_error(*poses).mean(), np.degrees(orientation_error(*poses).mean())
    assert found == pytest.approx(means, rel=0.02)


def test_where_no_scenario_has_a_part_of_the_paper_s_damage_nothing_is_assigned(study, tmp_path):
    _, table = resolve(study, "ur10", ["intact", "rotation"])
    assert table == {}
    evidence = Evidence(study, tmp_path)
    write(tmp_path / "results/assignments/ur10.parquet", pd.DataFrame(table))
    with pytest.raises(NotMeasured, match="assigned"):
        evidence.assignments()


def test_every_run_of_every_scenario_has_luck_of_its_own_that_repeats(plan):
    """Another learner meets the same noise."""
    noisy = Noise(1e-3, 1e-3), Outliers(0.3, 0.05), Repeatability(1e-3)
    commands = np.zeros((1, 4, 6))

    def met(name, seed, runs):
        resolved = changed(plan.resolved("intact"), scenario=name, damages=noisy)
        plant = resolved.plant(resolved.controller(), seed, runs)
        return plant.execute(np.repeat(commands, len(runs), axis=0)).achieved

    both = met("noise", 1, [3, 4])
    assert np.array_equal(both[1:], met("noise", 1, [4]))
    for other in (both[:1], met("outliers", 1, [4]), met("noise", 2, [4])):
        assert not np.isclose(both[1:], other).any()


LINKS = ["upper_arm_link", "forearm_link", "wrist_1_link", "wrist_2_link"]


def test_the_paper_allows_5760_different_assignments(robot):
    ways = Ways(LINKS, [0.01, 0.01, 0.04], robot.joints, np.radians([4, 3, 4]))
    assert (len(ways.short), len(ways.shifted), len(ways)) == (12, 480, 5760)
    assert len({ways[index] for index in range(len(ways))}) == 5760
    ways = Ways(LINKS, [0.01, 0.04], robot.joints, [0.05, 0.06])
    for index in range(0, len(ways), 37):
        links, joints = ways[index][:2], ways[index][2:]
        assert LINKS.index(links[0].link) < LINKS.index(links[1].link)
        assert robot.joints.index(joints[0].encoder) < robot.joints.index(joints[1].encoder)


@pytest.fixture(scope="module")
def assigned(plan, robot):
    """All ways, the poses that they are compared at, their errors, and the way that is taken."""
    published = Published(position_error_cm=5.0, orientation_error_deg=3.0)
    amounts = {"shorten": (0.01, 0.04), "shift": (0.05,), "poses": 10}
    damage = PaperDamage.model_construct(published=published, **amounts)
    ways = Ways(LINKS, damage.shorten, robot.joints, damage.shift)
    poses = robot.workspace.sample(generator(1, "assignments"), 10)
    return ways, poses, *assign(plan.nominal("ur10"), damage, seed=1)


def test_every_row_has_the_errors_of_its_damages(assigned, controller, robot):
    ways, poses, table, assignment = assigned
    assert len(table["distance"]) == len(ways) == 12 * 12
    desired = robot.workspace.to_poses(poses)
    for index in range(0, len(ways), 29):
        achieved = apply(robot, ways[index]).forward(controller.inverse(desired))
        position = 100 * position_error(achieved, desired).mean()
        orientation = np.degrees(orientation_error(achieved, desired).mean())
        assert table["position_error_cm"][index] == pytest.approx(position)
        assert table["orientation_error_deg"][index] == pytest.approx(orientation)
    assert assignment == ways[table["distance"].round(9).argmin()]


def test_the_distance_is_the_larger_relative_deviation(assigned, controller):
    ways, poses, table, _ = assigned
    position, orientation, _ = (column[3] for column in table.values())
    exact = Published(position_error_cm=position, orientation_error_deg=orientation)
    off = Published(position_error_cm=position / 1.5, orientation_error_deg=orientation)
    small = Published(position_error_cm=position / 0.7, orientation_error_deg=orientation)
    found, nearest = compare(controller, ways, poses, exact)
    assert (found["distance"][3], nearest) == (0, 3)
    assert compare(controller, ways, poses, off)[0]["distance"][3] == pytest.approx(0.5)
    scaled, nearest = compare(controller, ways, poses, small, scale=0.7)
    assert scaled["distance"][3] == pytest.approx(0) and nearest == 3
