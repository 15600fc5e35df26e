import copy

import numpy as np
import pytest

from recalib.damaged.damage import BaseShift, EncoderShift, LinkShortening
from recalib.damaged.disturbances import Disturbances
from recalib.damaged.nongeometric import Backlash, EccentricGear, Sag
from recalib.errors import InvalidQuantity, InvalidSetting, UnfitWorkspace, UnknownName
from recalib.study import scenarios
from recalib.study.evidence.claims import missing
from recalib.study.experiments import campaign

ASSIGNMENT = [
    {"link": "forearm_link", "shorten": "4 cm"},
    {"encoder": "elbow_joint", "shift": "-3 deg"},
]


@pytest.mark.parametrize(
    ("entry", "damage"),
    [
        ({"link": "forearm_link", "shorten": "4 cm"}, LinkShortening("forearm_link", 0.04)),
        (
            {"encoder": "elbow_joint", "shift": "-3 deg"},
            EncoderShift("elbow_joint", -np.radians(3)),
        ),
        ({"translate": ["1 cm", "0 cm", "-2 mm"]}, BaseShift(translation=(0.01, 0.0, -0.002))),
        ({"rotate": ["0 deg", "180 deg", "0 deg"]}, BaseShift(rotation=(0.0, np.pi, 0.0))),
        (
            {"gear": "elbow_joint", "eccentricity": "0.5 deg", "phase": "90 deg"},
            EccentricGear("elbow_joint", np.radians(0.5), np.pi / 2),
        ),
        ({"sag": "elbow_joint", "compliance": "0.01 rad/Nm"}, Sag("elbow_joint", 0.01)),
        ({"backlash": "elbow_joint", "gap": "0.1 rad"}, Backlash("elbow_joint", 0.1)),
    ],
)
def test_damages_read_as_the_paper_writes_them(entry, damage):
    assert scenarios.parse_damage(entry) == damage


def test_disturbances_are_read_beside_damages():
    entries = [
        {"noise": {"position": "0.2 mm", "orientation": "1 rad"}},
        {"repeatability": "0.5 rad"},
        {"link": "forearm_link", "shorten": "4 cm"},
        {"outliers": {"share": 0.1, "size": "5 cm"}},
    ]
    assert scenarios.parse_disturbances(entries) == Disturbances(0.0002, 1.0, 0.5, 0.1, 0.05)
    assert scenarios.parse_damages(entries) == [LinkShortening("forearm_link", 0.04)]
    assert scenarios.parse_disturbances(entries[2:3]) is None


@pytest.mark.parametrize("entry", ASSIGNMENT)
def test_a_damage_survives_the_round_trip(entry):
    assert scenarios.describe_damage(scenarios.parse_damage(entry)) == entry


def test_assigned_damages_are_replaced_by_their_part_of_the_assignment():
    entries = [{"translate": ["1 cm", "0 cm", "0 cm"]}, {"assigned": "encoders"}]
    assert scenarios.resolve(entries, ASSIGNMENT) == [entries[0], ASSIGNMENT[1]]
    assert scenarios.is_assigned(entries) and not scenarios.is_assigned(entries[:1])


def test_a_scenario_may_name_its_robot(config):
    assert scenarios.robot_of("links", config) == ("links", "ur10")
    assert scenarios.robot_of("links_encoders-z1", config) == ("links_encoders", "z1")
    with pytest.raises(UnknownName, match="intact, links"):
        scenarios.robot_of("link", config)
    with pytest.raises(UnknownName, match="ur10, ur3, ur5, z1"):
        scenarios.robot_of("links-ur7", config)


@pytest.mark.parametrize(
    ("damage", "error", "message"),
    [
        ({"link": "forearm", "shorten": "4 cm"}, UnknownName, "forearm_link"),
        ({"encoder": "elbow", "shift": "4 deg"}, UnknownName, "elbow_joint"),
        ({"link": "forearm_link", "shorten": "4 deg"}, InvalidQuantity, "cm, m, mm"),
        ({"link": "forearm_link", "shorten": "58 cm"}, InvalidSetting, "57.23 cm, its length"),
        ({"twist": "3 deg"}, UnknownName, "encoder \\+ shift"),
    ],
)
def test_an_impossible_damage_is_found_before_anything_runs(config, damage, error, message):
    broken = copy.deepcopy(config)
    broken["scenarios"]["mine"] = [damage]
    broken["experiments"]["scenarios"].append("mine")
    with pytest.raises(error, match=message):
        scenarios.check(broken)


@pytest.mark.parametrize(
    ("path", "value", "error", "message"),
    [
        ("robots.z1.tool", "nope", UnknownName, "gripperStator"),
        ("robots.z1.workspace.position", ["150 cm"] * 3, UnfitWorkspace, "the z1 cannot reach"),
        ("robots.z1.links", ["forearm", "link03", "link04"], UnknownName, "link02"),
        ("experiments.robots", ["ur7"], UnknownName, "ur10, ur3, ur5, z1"),
        ("paper_damage.shorten", ["1 cm", "80 cm"], InvalidSetting, "its length"),
        ("paper_damage.shorten", ["1 cm"] * 5, InvalidSetting, "at most 4"),
        ("search.ranges.initial_width", [5, 0.2], InvalidSetting, "lower value first"),
        ("experiments.scenarios", ["damaged"], UnknownName, "links_encoders"),
    ],
)
def test_whatever_the_default_run_uses_is_checked_before_it(config, path, value, error, message):
    broken = copy.deepcopy(config)
    *parents, key = path.split(".")
    place = broken
    for parent in parents:
        place = place[parent]
    place[key] = value
    with pytest.raises(error, match=message):
        scenarios.check(broken)


def test_evidence_without_its_trainings_is_refused(config):
    assert missing(config) == []
    lacking = copy.deepcopy(config)
    lacking["experiments"]["paper"].remove("improved_single_map")
    lacking["studies"]["scales"] = [0.5]
    assert missing(lacking) == ["experiments.paper: improved_single_map", "studies.scales: 1"]


def test_the_configuration_of_the_project_passes(config):
    scenarios.check(config)


def test_compared_learners_see_the_same_poses_and_never_the_tests():
    short, long = (
        campaign.desired_poses(1, "links", range(3), 20),
        campaign.desired_poses(1, "links", range(1, 3), 200),
    )
    assert np.array_equal(short[1:], long[:, :20])
    tests = campaign.test_poses(1, "links", range(3), 20)
    assert not np.isclose(tests, short).any()
    assert not np.isclose(short, campaign.desired_poses(1, "encoders", range(3), 20)).any()
    assert not np.isclose(short[0], short[1]).any()
