"""Arms of one's own: each that can serve its workspace is run, and what is in its files counts."""

import numpy as np
import pytest
import yaml

from recalib import load_arm
from replication.config import InvalidConfiguration
from replication.running import study_of
from tests.arms import LIBRARY
from tests.conftest import ROOT


def entry_of(row) -> dict:
    """A row of the table as an entry of `robots`."""
    arm = load_arm(row["urdf"], row["tool"])
    limits = np.clip([arm.model.lowerPositionLimit, arm.model.upperPositionLimit], -3, 3)
    home = row.get("home", np.degrees(limits.mean(axis=0)))
    *position, orientation = row.get("workspace", (10, 12, 10, 20))
    return {
        "urdf": row["urdf"],
        "tool": row["tool"],
        "home": {joint: f"{angle} deg" for joint, angle in zip(arm.joints, home, strict=True)},
        "workspace": {
            "position": [f"{side} cm" for side in position],
            "orientation": [f"{orientation} deg"] * 3,
        },
        "links": row.get("links", [row["tool"]]),
    }


def with_arm(folder, entry, **more):
    """As read before anything runs, like quick and with the paper's damage."""
    path = folder / "mine.yaml"
    mine = {"like": "quick", "robot": "mine", "robots": {"mine": entry}}
    path.write_text(yaml.safe_dump(mine | more))
    return study_of(ROOT, [path])


@pytest.mark.parametrize("row", LIBRARY, ids=[row["urdf"] for row in LIBRARY])
def test_an_arm_is_run_or_refused_in_a_sentence_that_is_true(row, tmp_path):
    if "says" not in row:
        assert with_arm(tmp_path, entry_of(row)).robot == "mine"
        return
    with pytest.raises(InvalidConfiguration) as caught:
        with_arm(tmp_path, entry_of(row))
    (message,) = caught.value.mistakes
    assert message.endswith(f": robots.mine.{row['says']}")


@pytest.mark.parametrize("robot", ["z1", "jaco", "ur3", "ur5"])
def test_a_robot_of_config_yaml_has_the_damages_that_it_declares_and_no_others(robot, tmp_path):
    """`gears` and `sag` of config.yaml are about the joints of a UR10, and are not run."""
    links = yaml.safe_load((ROOT / "config.yaml").read_text())["robots"][robot]["links"]
    fall = {"fall": [{"link": links[0], "shorten": "1 cm"}]}
    plan = {"scenario": "fall", "scenarios": fall, "experiments": {"scenarios": ["fall"]}}
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump({"like": "quick", "robot": robot} | plan))
    assert study_of(ROOT, [path]).robot == robot


def test_links_of_ones_own_are_asked_of_the_papers_damage_alone_where_it_is_used(tmp_path):
    panda = next(row for row in LIBRARY if row["urdf"] == "panda.urdf")
    entry = entry_of(panda | {"links": ["panda_link5"]})  # which has no length
    fall = {"fall": [{"encoder": "panda_joint4", "shift": "3 deg"}]}
    plan = {"scenario": "fall", "scenarios": fall, "experiments": {"scenarios": ["fall"]}}
    assert with_arm(tmp_path, entry, **plan).scenario == "fall"
    message = "list of 3; expected: at most 1, one for each of robots.mine.links"
    with pytest.raises(InvalidConfiguration, match=message):
        with_arm(tmp_path, entry)
