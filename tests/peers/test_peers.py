"""What is ours of the comparison: the tasks, and the page."""

from collections.abc import Callable

import numpy as np
import pandas as pd
import pytest
import scipy.linalg

from recalib.identification.observations import Observations
from recalib.nominal.arms import load_arm
from recalib.nominal.descriptions import find_urdf
from recalib.nominal.kinematics import Arm
from tests.identification.bars import ARMS
from tests.identification.real import Real, anywhere
from tests.peers.__main__ import PEERS
from tests.peers.page import HERE, PAGE, WHO, context, render
from tests.peers.tasks import (
    FAR,
    OUTLIERS,
    POSES,
    SHIFTED,
    SHORTENED,
    SUBSETS,
    Shortened,
    Task,
    recorded,
    simulated,
)
from tests.test_architecture import imported

VERSIONS = {"figaroh": "1.0", "robotkinecal": "0.1"}


def perfect(name: str, measured: Callable[[np.ndarray], np.ndarray], told: bool = True) -> Task:
    """A task about an arm that is as the nominal one, of which a part of the pose is measured."""
    arm, random = load_arm(*ARMS[name]), np.random.default_rng(1)
    base, target = anywhere(random, 2.0), anywhere(random, 0.2)
    joints = random.uniform(-2, 2, (5, len(arm.joints)))
    seen = measured(base @ arm.forward(joints) @ target)
    frames = (base, target) if told else None
    urdf = find_urdf(ARMS[name][0])
    return Task("perfect", 0, arm, urdf, Observations(joints, seen), joints, seen, frames)


def poses(its: np.ndarray) -> np.ndarray:
    return its


def positions(its: np.ndarray) -> np.ndarray:
    return its[:, :3, 3]


@pytest.mark.parametrize("measured", [poses, positions])
def test_who_is_told_the_frames_of_a_perfect_arm_misses_nothing(measured):
    task = perfect("Panda", measured)
    assert task.error(task.nominal()) < 1e-12
    base, target = task.told
    found = base @ task.arm.forward(task.fresh) @ target
    assert task.error(task.predicted(found)) < 1e-12
    found[:, 2, 3] += 1e-3
    assert task.error(task.predicted(found)) == pytest.approx(1e-3)


def test_nobody_told_means_that_all_is_in_the_frame_of_the_instrument():
    task = perfect("UR10", poses, told=False)
    assert task.nominal() is None
    assert task.as_told(task.truth) is task.truth
    assert task.error(task.predicted(task.truth)) == 0


@pytest.mark.parametrize("measured", [poses, positions])
@pytest.mark.parametrize("name", ARMS)
def test_the_axes_that_a_peer_is_given_are_those_of_the_nominal_arm(name, measured, tmp_path):
    """By the product of exponentials, as robotkinecal has it."""
    task = perfect(name, measured)
    task.write(tmp_path)
    with np.load(tmp_path / "perfect-000.npz") as file:
        given = dict(file)
    for joints, seen in zip(given["joints"], given["measured"], strict=True):
        pose = given["home"]
        for (*moment, x, y, z), angle in [*zip(given["screws"], joints, strict=True)][::-1]:
            turn = [[0, -z, y], [z, 0, -x], [-y, x, 0]]
            twist = np.vstack([np.column_stack([turn, moment]), np.zeros(4)])
            pose = scipy.linalg.expm(angle * twist) @ pose
        expected = pose if measured is poses else pose[:3, 3]
        np.testing.assert_allclose(seen, expected, atol=1e-12)


def test_a_peer_is_not_given_the_truth(tmp_path):
    task = simulated("panda", "Panda", Real, 0)
    task.write(tmp_path)
    with np.load(tmp_path / "panda-000.npz") as given:
        assert {*given} == {
            *("urdf", "packages", "tool", "names", "joints", "measured", "fresh", "told"),
            *("noise", "known", "screws", "home"),
        }
        assert len(given["measured"]) == len(given["joints"]) == POSES
        assert not np.isin(given["fresh"], given["joints"]).any()


def changes(arm: Arm, real: Shortened) -> np.ndarray:
    """By how much [m] the links are shorter."""
    lengths = (
        [np.linalg.norm(placement.translation) for placement in each.model.jointPlacements]
        for each in (arm, real._arm)
    )
    return np.subtract(*lengths)


def test_the_damage_of_the_paper_is_done_to_three_links_and_three_joints():
    arm = load_arm(*ARMS["UR10"])
    real, other = Shortened(arm, 0), Shortened(arm, 1)
    lost = changes(arm, real)
    np.testing.assert_allclose(sorted(lost[np.abs(lost) > 1e-12]), SHORTENED)
    assert sorted(np.abs(real._offsets[real._offsets != 0])) == sorted(SHIFTED)
    assert np.abs(lost - changes(arm, other)).max() > 0.005


def test_outliers_are_far_off_and_the_rest_is_noise():
    clean, rough = (
        simulated("ur10", "UR10", Shortened, 0, outliers=share) for share in (0.0, OUTLIERS)
    )
    gaps = rough.observations.measured[:, :3, 3] - clean.observations.measured[:, :3, 3]
    off = np.linalg.norm(gaps, axis=1)
    assert np.sum(off > 0) == OUTLIERS * POSES
    np.testing.assert_allclose(off[off > 0], FAR)


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
    assert len({task.name for task in tasks}) == len(tasks)
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
        return (errors.scenario == scenario) & (errors.who == who)

    errors.loc[those("panda", "robotkinecal") & (errors.draw == 1), "error_mm"] = np.nan
    errors.loc[those("ur10", "robotkinecal"), "error_mm"] = np.nan
    errors.loc[those("untold", "robotkinecal") & (errors.draw == 0), "error_mm"] = 2.5
    errors.loc[those("untold", "figaroh, map"), "error_mm"] = np.nan
    errors.loc[(errors.scenario == "ur10") & errors.who.str.startswith("figaroh"), "error_mm"] = (
        np.nan
    )
    rest = errors[~those("ur5_20", "figaroh, map_cv")]
    said = context(rest, VERSIONS)
    assert said["errors"]["robotkinecal"][:3] == ["0.300, 1 failed", "nothing", "0.400 (0.500)"]
    assert said["errors"]["figaroh, map_cv"][-1] == "-"
    assert [each["title"] for each in said["scenarios"]][-2:] == ["UR10, outliers", "real UR5"]
    assert [each["rows"] for each in said["scenarios"]] == [30, 30, 30, 20]
    assert said["scenarios"][0]["ratio"] == "1.80", "0.9 over 0.5, the least of figaroh's"
    assert said["scenarios"][1]["ratio"] == "-", "there is none of figaroh's"
    right = {each["who"]: (each["right"], each["of"]) for each in said["untold"]}
    assert (right["robotkinecal"], right["figaroh, map"], right["recalib"]) == (
        (1, 2),
        (0, 2),
        (2, 2),
    )


def test_without_a_recording_the_page_says_nothing_of_the_real_arm(errors):
    page = render(errors[errors.scenario != "ur5_20"], VERSIONS)
    assert "real UR5" in render(errors, VERSIONS) and "UR5" not in page.split("## Features")[0]


def test_every_no_of_a_peer_says_where_that_was_seen(errors):
    said = context(errors, VERSIONS)
    rows = [row for part in said["features"] for row in part["rows"]]
    for row in rows:
        for peer in VERSIONS:
            if row[peer].startswith("no"):
                assert row[peer].endswith("]"), f"{row['what']} of {peer}: where was that seen?"
    assert len({*said["notes"]}) == len(said["notes"])


def test_the_committed_page_has_the_features_that_are_listed(errors):
    """Its errors come from `make peers`."""
    page, made = PAGE.read_text(encoding="utf-8"), render(errors, PEERS)
    assert page.split("## Features")[1] == made.split("## Features")[1]


@pytest.mark.parametrize("script", ["by_figaroh.py", "by_robotkinecal.py"])
def test_a_peer_runs_without_anything_of_ours(script):
    names = {name.split(".")[0] for name in imported(HERE / script)}
    assert not names & {"recalib", "tests", "workflow"} and len(names) > 3
