"""Our part of the comparison: the tasks, and the page."""

import re

import numpy as np
import pandas as pd
import pytest
import scipy.linalg

from recalib.identification.model.observations import Observations
from recalib.nominal import find_urdf
from recalib.nominal.arms import load_arm
from tests.identification.real import ARMS, Real, anywhere
from tests.peers.__main__ import PEERS
from tests.peers.page import HERE, PAGE, WHO, context, render
from tests.peers.tasks import POSES, SHORTENED, SUBSETS, Shortened, Task, recorded, simulated


def perfect(name: str, positions: bool, frames_known: bool = True) -> Task:
    """A task about an arm that is as the nominal one."""
    arm, random = load_arm(*ARMS[name]), np.random.default_rng(1)
    base, target = anywhere(random, 2.0), anywhere(random, 0.2)
    joints = random.uniform(-2, 2, (5, len(arm.joints)))
    measured = base @ arm.forward(joints) @ target
    if positions:
        measured = measured[:, :3, 3]
    frames = (base, target) if frames_known else None
    urdf = find_urdf(ARMS[name][0])
    observations = Observations(joints, measured)
    return Task("perfect", 0, arm, urdf, observations, joints, measured, frames)


@pytest.mark.parametrize("positions", [False, True])
def test_with_known_frames_a_perfect_arm_has_no_error(positions):
    task = perfect("Panda", positions)
    assert task.error(task.nominal()) < 1e-12
    base, target = task.frames
    poses = base @ task.arm.forward(task.fresh) @ target
    assert task.error(task.predicted(poses)) < 1e-12
    poses[:, 2, 3] += 1e-3
    assert task.error(task.predicted(poses)) == pytest.approx(1e-3)


def test_with_unknown_frames_all_is_in_the_frame_of_the_instrument():
    task = perfect("UR10", positions=False, frames_known=False)
    assert task.nominal() is None
    assert task.in_base(task.truth) is task.truth
    assert task.error(task.predicted(task.truth)) == 0


@pytest.mark.parametrize("positions", [False, True])
@pytest.mark.parametrize("name", ARMS)
def test_the_axes_that_a_peer_is_given_are_those_of_the_nominal_arm(name, positions, tmp_path):
    """By the product of exponentials, as robotkinecal has it."""
    task = perfect(name, positions)
    task.write(tmp_path)
    with np.load(tmp_path / "perfect-000.npz") as file:
        arrays = dict(file)
    for joints, measured in zip(arrays["joints"], arrays["measured"], strict=True):
        pose = arrays["home"]
        for (*moment, x, y, z), angle in [*zip(arrays["screws"], joints, strict=True)][::-1]:
            turn = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
            twist = np.vstack([np.column_stack([turn, moment]), np.zeros(4)])
            pose = scipy.linalg.expm(angle * twist) @ pose
        np.testing.assert_allclose(measured, pose[:3, 3] if positions else pose, atol=1e-12)


def test_a_peer_is_not_given_the_truth(tmp_path):
    simulated("panda", "Panda", Real, 0).write(tmp_path)
    with np.load(tmp_path / "panda-000.npz") as arrays:
        assert "truth" not in arrays
        assert len(arrays["measured"]) == len(arrays["joints"]) == POSES
        assert not np.isin(arrays["fresh"], arrays["joints"]).any()


def test_the_damage_of_the_paper_is_done_to_three_links():
    arm = load_arm(*ARMS["UR10"])
    arms = arm, Shortened(arm, 0)._arm
    lengths = [
        [np.linalg.norm(placement.translation) for placement in each.model.jointPlacements]
        for each in arms
    ]
    lost = np.subtract(*lengths)
    np.testing.assert_allclose(sorted(lost[np.abs(lost) > 1e-12]), SHORTENED)


def test_the_recording_is_read_with_its_own_description(tmp_path):
    arm, random = load_arm("ur5_robot.urdf", "tool0"), np.random.default_rng(0)
    for name, count in (("grid_1000", 1000), ("random_20", 20)):
        joints = random.uniform(-1, 1, (count, 6))
        table = {f"joint_{number + 1}": np.degrees(joints[:, number]) for number in range(6)}
        tool = arm.forward(joints) @ np.array([0, 7e-5, 0.031, 1])
        turned = 1e3 * tool[:, :3] * [-1, -1, 1]
        table |= {f"{axis}_t": turned[:, i] for i, axis in enumerate("xyz")}
        table |= {"x_dif": 3.0, "y_dif": 0.0, "z_dif": 4.0}
        pd.DataFrame(table).to_csv(tmp_path / f"{name}.csv", index_label="step_order")
    tasks = list(recorded(tmp_path))
    assert [len(task.observations) for task in tasks] == [
        count for count, subsets in SUBSETS.items() for _ in range(subsets)
    ]
    for task in tasks:
        assert task.error(task.nominal()) == pytest.approx(5e-3, rel=1e-6)


@pytest.fixture
def errors() -> pd.DataFrame:
    rows = [
        {"scenario": scenario, "draw": draw, "who": who, "error_mm": 0.1 * (index + 1) + 0.2 * draw}
        for scenario in ("panda", "ur10", "ur10_outliers", "untold", "ur5_20")
        for draw in range(2)
        for index, who in enumerate(WHO)
    ]
    return pd.DataFrame(rows)


def test_the_page_has_the_mean_the_worst_and_what_failed(errors):
    def those(scenario: str, who: str) -> pd.Series:
        return (errors.scenario == scenario) & errors.who.str.startswith(who)

    errors.loc[those("panda", "robotkinecal") & (errors.draw == 1), "error_mm"] = np.nan
    errors.loc[those("ur10", "robotkinecal"), "error_mm"] = np.nan
    errors.loc[those("ur10", "figaroh"), "error_mm"] = np.nan
    errors.loc[those("untold", "robotkinecal") & (errors.draw == 0), "error_mm"] = 2.5
    page = context(errors[~those("ur5_20", "figaroh, map_cv")], PEERS)
    assert page["errors"]["robotkinecal"][:3] == ["0.300, 1 failed", "nothing", "0.400 (0.500)"]
    assert page["errors"]["figaroh, map_cv"][-1] == "-"
    ratios = [scenario["ratio"] for scenario in page["scenarios"][:2]]
    assert ratios == ["1.80", "-"], "0.9 over 0.5, the least of figaroh's, and none of them"
    right = {row["who"]: (row["right"], row["of"]) for row in page["unknown_frames"]}
    assert (right["robotkinecal"], right["recalib"]) == ((1, 2), (2, 2))


def test_without_a_recording_the_page_says_nothing_of_the_real_arm(errors):
    page = render(errors[errors.scenario != "ur5_20"], PEERS)
    assert "real UR5" in render(errors, PEERS) and "UR5" not in page.split("## Features")[0]


def test_the_committed_page_has_all_features_and_every_no_has_its_evidence(errors):
    """Its errors come from `make peers`."""
    page, rendered = PAGE.read_text(encoding="utf-8"), render(errors, PEERS)
    assert page.split("## Features")[1] == rendered.split("## Features")[1]
    for row in context(errors, PEERS)["features"]:
        without = {peer for peer in PEERS if row[peer].startswith("no")}
        assert without <= {*row.get("where", {})}, row


@pytest.mark.parametrize("script", ["by_figaroh.py", "by_robotkinecal.py"])
def test_a_peer_runs_without_anything_of_ours(script):
    text = (HERE / script).read_text(encoding="utf-8")
    names = {*re.findall(r"^\s*(?:from|import) (\w+)", text, re.MULTILINE)}
    assert not names & {"recalib", "tests", "workflow"} and len(names) > 3
