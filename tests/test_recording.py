import subprocess
from contextlib import nullcontext
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import rerun_cli
from PIL import Image
from rerun.chunk import RrdReader
from scipy.spatial.transform import Rotation

from recalib.damaged.damage import BaseShift, EncoderShift, LinkShortening, apply
from recalib.damaged.plant import Plant
from recalib.learners.hierarchical import HierarchicalLearner, Rules, Schedule
from recalib.nominal.poses import position_error
from recalib.study.recording import (
    AFTER,
    BEFORE,
    BrokenRecording,
    arms,
    check_recording,
    scene,
    story,
    take_pictures,
    write_recording,
)
from recalib.training import train

RERUN = Path(rerun_cli.__file__).with_name("rerun")
MEASURE_AT = range(0, 41, 4)
DAMAGES = (
    BaseShift(translation=(0.01, 0.0, -0.02)),
    LinkShortening("forearm_link", 0.04),
    EncoderShift("elbow_joint", np.radians(-4)),
)
DRIVERS = [
    *Path("/usr/share/vulkan/icd.d").glob("*.json"),
    *Path("/etc/vulkan/icd.d").glob("*.json"),
]


def learners():
    widths = {"position": (0.6, 1.4), "orientation": (0.7, 1.2)}
    improved = HierarchicalLearner(
        1, Rules(True, True, True, True), Schedule(3.8, widths, 0.8, 0.4)
    )
    ritter = HierarchicalLearner(
        1, Rules(False, False, False, False), Schedule(0.5, {"pose": (0.2, 0.3)}, 0.4, 0.1)
    )
    return {"improved": improved, "ritter": ritter}


def poses():
    generator = np.random.default_rng(7)
    return generator.uniform(-1, 1, (40, 6)), generator.uniform(-1, 1, (30, 6))


@pytest.fixture(scope="module")
def write(controller):
    """Write a recording of these damages."""
    return lambda path, damages: write_recording(
        path, damages, controller, learners(), *poses(), MEASURE_AT, {"robot": "ur10", "seed": "7"}
    )


@pytest.fixture(scope="module")
def recording(tmp_path_factory, write):
    path = tmp_path_factory.mktemp("recordings") / "links_encoders.rrd"
    return path, write(path, DAMAGES)


@pytest.fixture(scope="module")
def columns(recording):
    """A function that returns a column of an entity, over one timeline or static: its times, its values."""
    batches = [
        (chunk.entity_path, chunk.to_record_batch())
        for chunk in RrdReader(recording[0]).store().stream().to_chunks()
    ]

    def column(entity, component, timeline=None):
        for path, batch in batches:
            found = (
                timeline in batch.schema.names
                if timeline
                else not {"time", "iteration"} & set(batch.schema.names)
            )
            if path == entity and component in batch.schema.names and found:
                return batch.column(timeline).to_pylist() if timeline else None, batch.column(
                    component
                ).to_pylist()
        raise KeyError((entity, component, timeline))

    return column


@pytest.fixture(scope="module")
def results(controller):
    """The same trainings, done without a recording."""
    desired, tests = poses()
    plant = Plant(controller, [apply(controller.robot, DAMAGES)])
    return {
        name: pd.DataFrame(train(plant, learner, desired[None], tests[None], MEASURE_AT).columns())
        for name, learner in learners().items()
    }


def test_a_recording_is_valid_and_small(recording, results):
    path, _ = recording
    check_recording(path, results)
    subprocess.run([RERUN, "rrd", "verify", path], check=True, capture_output=True)
    assert path.stat().st_size < 20e6


def test_recorded_errors_are_those_of_the_experiment(columns, results):
    for name, frame in results.items():
        for quantity in ("position_error_cm", "orientation_error_deg"):
            iterations, values = columns(
                f"/errors/{quantity}/{name}", "Scalars:scalars", "iteration"
            )
            assert dict(zip(iterations, np.ravel(values), strict=True)) == dict(
                zip(frame["iteration"], frame[quantity], strict=True)
            )
            _, logarithms = columns(f"/log10/{quantity}/{name}", "Scalars:scalars", "iteration")
            assert np.allclose(10 ** np.ravel(logarithms), np.ravel(values))


def test_landings_are_where_the_damaged_arm_lands(controller, columns):
    desired, tests = poses()
    shown = story.visiting_order(tests[: story.POSES])
    plant = Plant(controller, [apply(controller.robot, DAMAGES)])
    goals = controller.robot.workspace.to_poses(shown)
    untrained, _ = plant.achieve(shown[None])
    learner = learners()["improved"]
    train(plant, learner, desired[None], tests[None], MEASURE_AT)
    trained, _ = plant.achieve(learner.command(shown[None]))

    iterations, axes = columns("/improved/achieved", "LineStrips3D:strips", "iteration")
    _, misses = columns("/improved/miss", "LineStrips3D:strips", "iteration")
    assert sorted(set(iterations)) == list(MEASURE_AT)
    for row, achieved in ((0, untrained[0]), (-1, trained[0])):
        length = scene.AXIS * scene.unit_of(controller.robot.workspace)
        expected = achieved[:, :3, 3:] + length * achieved[:, :3, :3]
        tips = np.reshape(axes[row], (-1, 3, 2, 3))[:, :, 1].swapaxes(1, 2)
        assert np.allclose(tips, expected, atol=1e-6)
        ends = np.stack([goals[:, :3, 3], achieved[:, :3, 3]], axis=1)
        assert np.allclose(misses[row], ends, atol=1e-6)
    _, frames = columns("/desired", "LineStrips3D:strips")
    assert np.allclose(np.reshape(frames[0], (-1, 3, 2, 3))[:, 0, 0], goals[:, :3, 3], atol=1e-6)
    assert (
        position_error(trained[0], goals).mean() < 0.2 * position_error(untrained[0], goals).mean()
    )


@pytest.mark.parametrize("timeline", ["time", "iteration"])
def test_the_damaged_arm_ends_where_it_lands_and_the_ghost_where_it_was_sent(
    robot, recording, columns, timeline
):
    training = recording[1]["improved"]
    tool = robot.arm.model.frames[robot.arm.model.getFrameId("tool0")].placement
    motion = story.move(training, robot.home)
    row = -1  # at rest at the last pose, trained
    for arm, expected in (
        ("damaged", training.achieved[-1, -1]),
        ("nominal", robot.arm.forward(training.angles[-1, -1:])[0]),
    ):
        _, positions = columns(f"/{arm}/wrist_3_link", "Transform3D:translation", timeline)
        _, quaternions = columns(f"/{arm}/wrist_3_link", "Transform3D:quaternion", timeline)
        turn = Rotation.from_quat(quaternions[row][0]).as_matrix()
        assert np.allclose(positions[row][0] + turn @ tool.translation, expected[:3, 3], atol=1e-6)
        assert np.allclose(turn @ tool.rotation, expected[:3, :3], atol=1e-6)
    assert len(positions) == len(motion.times if timeline == "time" else MEASURE_AT)


def test_a_shifted_base_is_drawn_shifted(columns):
    _, damaged = columns("/damaged/base_link", "Transform3D:translation", "time")
    _, nominal = columns("/nominal/base_link", "Transform3D:translation", "time")
    assert np.allclose(np.subtract(damaged, nominal), (0.01, 0.0, -0.02))


def test_the_map_starts_without_corrections_and_lights_up_at_its_winner(
    controller, recording, columns
):
    training = recording[1]["improved"]
    _, arrows = columns("/improved/map/corrections", "Arrows3D:vectors", "iteration")
    assert np.ptp(arrows[0]) == 0
    assert np.allclose(arrows[-1], training.corrections[-1], atol=1e-6)
    misses = (training.achieved[0] - training.desired)[:, :3, 3].mean(axis=0)
    assert (
        np.mean(arrows[-1], axis=0) @ misses < -0.5 * misses @ misses
    )  # they make up for the misses
    last = controller.robot.workspace.to_poses(poses()[0][-1])[:3, 3]
    winner = np.linalg.norm(training.centres - last, axis=-1).argmin()
    assert training.weights[-1].argmax() == winner and training.weights[-1, winner] == 1
    assert not training.weights[0].any()


def test_every_link_has_its_mesh(robot, columns):
    links = [
        frame.name
        for frame in robot.arm.model.frames
        if frame.name.endswith("_link") and frame.name != "ee_link"
    ]
    assert len(links) == 7
    for arm in ("damaged", "nominal"):
        for link in links:
            _, blobs = columns(f"/{arm}/ur10/visual_geometries/{link}/visual_0", "Asset3D:blob")
            assert len(blobs[0][0]) > 10_000
    _, tints = columns(
        "/nominal/ur10/visual_geometries/forearm_link/visual_0", "Asset3D:albedo_factor"
    )
    assert tints[0][0] % 256 < 128  # its opacity


def test_a_recording_says_what_it_shows(columns):
    for key, value in {"scenario": "links_encoders", "robot": "ur10", "seed": "7"}.items():
        assert columns("/__properties/run", key)[1] == [[value]]


def test_the_arm_moves_smoothly_and_rests_at_every_pose(robot, recording):
    training = recording[1]["improved"]
    motion = story.move(training, robot.home)
    act = len(motion.times) // 2
    for angles, stops in (
        (motion.angles[:act], training.angles[0]),
        (motion.angles[act:], training.angles[-1]),
    ):
        speed = np.abs(np.diff(angles, axis=0)).max(axis=-1)
        assert (
            speed.max() < 2 * np.pi / story.FRAMES_A_SECOND
        )  # rad a frame: never more than one turn a second
        resting = angles.reshape(len(stops), -1, 6)[:, -1]
        assert np.allclose(resting, stops)
    assert (np.diff(motion.times) > 0).all()
    assert (
        motion.arrivals[0, -1]
        < BEFORE
        < motion.learning[0]
        < motion.learning[-1]
        < AFTER
        < motion.end
    )


def test_two_recordings_of_the_same_are_equal_and_a_millimetre_shows(recording, write, tmp_path):
    compare = [RERUN, "rrd", "compare", "--unordered", recording[0]]
    again, other = tmp_path / "links_encoders.rrd", tmp_path / "other" / "links_encoders.rrd"
    write(again, DAMAGES)
    assert subprocess.run([*compare, again], capture_output=True).returncode == 0
    write(other, (*DAMAGES[:1], LinkShortening("forearm_link", 0.041), *DAMAGES[2:]))
    assert subprocess.run([*compare, other], capture_output=True).returncode != 0


def flipped(content, at):
    return content[:at] + bytes([content[at] ^ 1]) + content[at + 1 :]


@pytest.mark.parametrize(
    "spoil",
    [
        pytest.param(lambda content: b"", id="empty"),
        pytest.param(lambda content: content[:-1], id="last byte lost"),
        pytest.param(lambda content: content[: len(content) // 2], id="half"),
        pytest.param(lambda content: flipped(content, len(content) // 3), id="a bit in a mesh"),
        pytest.param(
            lambda content: flipped(content, len(content) - 1000), id="a bit near the end"
        ),
    ],
)
def test_a_spoilt_recording_is_refused(recording, results, tmp_path, spoil):
    spoilt = tmp_path / "spoilt.rrd"
    spoilt.write_bytes(spoil(recording[0].read_bytes()))
    with pytest.raises(BrokenRecording):
        check_recording(spoilt, results)


def test_a_recording_of_other_results_is_refused(recording, results):
    other = results["improved"].assign(
        position_error_cm=results["improved"]["position_error_cm"] + 1e-6
    )
    with pytest.raises(BrokenRecording, match="differs from the results"):
        check_recording(recording[0], {"improved": other})
    with pytest.raises(BrokenRecording, match="no /errors/position_error_cm/peer"):
        check_recording(recording[0], {"peer": other})


def test_missing_meshes_leave_no_recording(write, tmp_path, monkeypatch):
    monkeypatch.setattr(arms, "_packages", lambda urdf: nullcontext())
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    with pytest.raises(BrokenRecording, match="no mesh for"):
        write(tmp_path / "bare.rrd", DAMAGES)
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(
    not DRIVERS, reason="needs a Vulkan driver, for instance Debian's mesa-vulkan-drivers"
)
def test_the_viewer_shows_the_arm_miss_and_hit(recording, tmp_path):
    before, after = tmp_path / "before.png", tmp_path / "after.png"
    take_pictures(recording[0], {before: BEFORE, after: AFTER})
    orange = []
    for png in (before, after):
        pixels = np.asarray(Image.open(png).convert("RGB"), int)
        red, green, blue = np.moveaxis(pixels, -1, 0)
        orange.append(
            np.sum((red > 180) & (green < 140) & (blue < 100))
        )  # the colour of large misses alone
        assert pixels.shape[1] == 1400
        assert png.stat().st_size < 300_000
    assert orange[0] > 2000 > 20 * orange[1]
