import json
import shutil
import subprocess
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import rerun as rr
import rerun.blueprint as rrb
from PIL import Image
from rerun.chunk import RrdReader
from scipy.spatial.transform import Rotation

from recalib import meshes
from recalib.damaged.damage import BaseShift, EncoderShift, LinkShortening
from recalib.damaged.disturbances import Noise, Outliers, Repeatability
from recalib.damaged.nongeometric import Sag
from recalib.errors import InvalidFile
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.learners.rules import IMPROVED, Rules
from recalib.learners.schedules import Schedule
from recalib.nominal.poses import position_error
from recalib.study import jobs
from recalib.study.entrants import make_peer
from recalib.study.experiments import campaign, search
from recalib.study.experiments.poses import Stream, train_for_results
from recalib.study.experiments.samples import write_sample
from recalib.study.measured import ERRORS, errors_of
from recalib.study.plants import resolve
from recalib.study.recording import about, colours, marks, scatter, scene, story
from recalib.study.recording.acts import ACT, AFTER, ARM, BEFORE, FRAMES_A_SECOND, LEARNING, POSES
from recalib.study.recording.blueprint import TITLES, arrange, seen_from
from recalib.study.recording.files import record
from recalib.study.recording.picture import ViewerUnavailable, take_pictures
from recalib.study.recording.seal import SEAL, BrokenRecording, check_recording, write_sealed
from recalib.study.recording.viewer import PROGRAM, quiet
from recalib.study.recording.writing import write_recording
from recalib.study.statistics import typical
from tests.conftest import changed

SEED, ITERATIONS, TESTS = 7, 40, 30
MEASURE_AT = range(0, ITERATIONS + 1, 4)
DAMAGES = (
    BaseShift(translation=(0.01, 0.0, -0.02)),
    LinkShortening("forearm_link", 0.04),
    EncoderShift("elbow_joint", np.radians(-4)),
    Sag("shoulder_lift_joint", 0.0002),
    Noise(0.0002, 0.0003),
)
DISTURBANCES = Outliers(0.3, 0.05), Repeatability(np.radians(0.02))
# of linear RGB: Machado, Oliveira and Fernandes, 2009
DEUTERANOPIA = np.array(
    [[0.367, 0.861, -0.228], [0.280, 0.673, 0.047], [-0.012, 0.043, 0.969]],
)
DRIVERS = [
    *Path("/usr/share/vulkan/icd.d").glob("*.json"),
    *Path("/etc/vulkan/icd.d").glob("*.json"),
]


def learner(name, runs=1):
    if name == "improved":
        widths = {"position": (0.6, 1.4), "orientation": (0.7, 1.2)}
        return HierarchicalLearner(runs, IMPROVED, Schedule(3.8, widths, 0.8, 0.4))
    rules, widths = Rules(False, False, False, False), {"pose": (0.2, 0.3)}
    return HierarchicalLearner(runs, rules, Schedule(0.5, widths, 0.4, 0.1))


def learners(job):
    return {name: learner(name) for name in job.learners}


@pytest.fixture(scope="module")
def job(study):
    """A recording of two learners."""
    return jobs.Recording(
        scenario="links_encoders",
        learners={
            name: study.learners[name].model_copy(update={"iterations": ITERATIONS})
            for name in ("improved", "ritter")
        },
        moves=5,
        measuring=jobs.Measuring(tests=TESTS, every=4, evenly=ITERATIONS, measurements=2),
        seed=SEED,
        published={"position_error_cm": 8.3, "orientation_error_deg": 4.7},
        meshes_sha256="",
    )


@pytest.fixture(scope="module")
def resolved(plan):
    """A scenario of these damages, on the study's robot or one changed."""

    def resolved(damages, **robot):
        nominal = changed(plan.nominal("ur10"), **robot)
        fields = {"name": "links_encoders", "nominal": nominal, "poses": 2, "seed": SEED}
        return resolve(jobs.Scenario(damages=damages, **fields))

    return resolved


def poses(runs=1, tests=TESTS):
    return Stream.SCENARIO.draw(SEED, range(runs), ITERATIONS, tests, scenario="links_encoders")


def experiment(job, resolved, runs=2):
    """What an experiment measures of its learners in its first run."""
    controller, measured = resolved.controller(), {}
    for name in job.learners:
        plant = resolved.plant(controller, SEED, range(runs))
        its = poses(runs, job.measuring.tests)
        history = train_for_results(plant, learner(name, runs), its, MEASURE_AT)
        frame = pd.DataFrame(history.columns())
        measured[name] = frame[frame["run"] == 0]
    return measured


@pytest.fixture(scope="module")
def write(job, resolved):
    """Write a recording of these damages."""

    def write(path, damages):
        its = resolved(damages)
        return write_recording(path, job, its, learners(job), experiment(job, its), 0)

    return write


@pytest.fixture(scope="module")
def recording(tmp_path_factory, write):
    path = tmp_path_factory.mktemp("recordings") / "links_encoders.rrd"
    return path, write(path, DAMAGES)


@pytest.fixture(scope="module")
def results(job, resolved):
    """The same trainings, done without a recording."""
    return experiment(job, resolved(DAMAGES))


@pytest.fixture(scope="module")
def columns(recording):
    """A function that returns a column of an entity: its times or None, and its values.

    It is over one timeline, or static.
    """
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


def test_a_recording_is_valid_and_small(recording, results):
    path, _ = recording
    check_recording(path, results)
    subprocess.run([PROGRAM, "rrd", "verify", path], env=quiet(), check=True, capture_output=True)
    assert path.stat().st_size < 20e6


def test_recorded_errors_are_those_of_the_experiment(columns, results):
    for name, frame in results.items():
        for quantity in ERRORS:
            moves, values = columns(f"/errors/{quantity}/{name}", "Scalars:scalars", "moves")
            assert dict(zip(moves, np.ravel(values), strict=True)) == dict(
                zip(frame["moves"], frame[quantity], strict=True)
            )


def test_landings_are_where_the_damaged_arm_lands(resolved, controller, columns):
    its = poses()
    shown = story.visiting_order(its.tests[0, :POSES])
    plant = resolved(DAMAGES).plant(controller, SEED, [0])
    goals = controller.robot.workspace.to_poses(shown)
    untrained, _ = plant.achieve(shown[None])
    improved = learner("improved")
    train_for_results(plant, improved, its, MEASURE_AT)
    trained, _ = plant.achieve(improved.command(shown[None]))

    moves, axes = columns("/improved/achieved", "LineStrips3D:strips", "moves")
    _, misses = columns("/improved/miss", "LineStrips3D:strips", "moves")
    assert sorted(set(moves)) == [2 * iteration for iteration in MEASURE_AT]
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


@pytest.mark.parametrize("timeline", ["time", "moves"])
@pytest.mark.parametrize("name", ["improved", "ritter"])
def test_each_arm_ends_where_it_lands_and_its_skeleton_where_it_was_sent(
    robot, recording, columns, timeline, name
):
    training = recording[1][name]
    tool = robot.arm.model.frames[robot.arm.model.getFrameId("tool0")].placement
    motion = story.move(training, robot.home, 2 * ITERATIONS)
    achieved = training.achieved[-1, -1]  # in the last row: at rest at the last pose, trained
    _, positions = columns(f"/{name}/links/wrist_3_link", "Transform3D:translation", timeline)
    _, quaternions = columns(f"/{name}/links/wrist_3_link", "Transform3D:quaternion", timeline)
    turn = Rotation.from_quat(quaternions[-1][0]).as_matrix()
    assert np.allclose(positions[-1][0] + turn @ tool.translation, achieved[:3, 3], atol=1e-6)
    assert np.allclose(turn @ tool.rotation, achieved[:3, :3], atol=1e-6)
    _, bones = columns(f"/{name}/believed/bones", "LineStrips3D:strips", timeline)
    _, joints = columns(f"/{name}/believed/joints", "Points3D:positions", timeline)
    sent = robot.arm.forward(training.angles[-1, -1:])[0, :3, 3]
    assert np.allclose(bones[-1][0][-1], sent, atol=1e-6)
    assert np.allclose(joints[-1], bones[-1][0]) and len(joints[-1]) == 8
    frames = len(motion.times if timeline == "time" else MEASURE_AT)
    assert len(positions) == len(bones) == frames


def test_a_shifted_base_is_drawn_shifted_beside_where_it_is_believed(columns):
    _, base = columns("/improved/links/base_link", "Transform3D:translation", "time")
    assert np.allclose(base, (0.01, 0.0, -0.02))
    circles = [
        np.reshape(columns(f"/improved/{which}/base", "LineStrips3D:strips")[1][0], (-1, 3))
        for which in ("wrong", "believed")
    ]
    assert np.allclose(circles[0] - circles[1], (0.01, 0.0, -0.02))
    assert columns("/improved/wrong/base/words", "Points3D:labels")[1] == [["moved 2.2 cm"]]


def test_what_is_wrong_is_marked_at_its_link_and_joint(robot, columns):
    unit = scene.unit_of(robot.workspace)
    found = marks.marks(robot, DAMAGES[:-1], unit)
    assert [(mark.link, mark.words) for mark in found] == [
        ("forearm_link", "4 cm short"),
        ("forearm_link", "encoder -4 deg"),
        ("upper_arm_link", "sag 0.0002 rad/Nm"),
    ]
    short, elbow, shoulder = found
    assert short.axis is None and np.linalg.norm(short.at) == pytest.approx(0.5723 / 2, abs=1e-3)
    # the shoulder lifts and the elbow bends about the y axis of their links
    for mark in (elbow, shoulder):
        assert np.allclose(np.diff(mark.axis, axis=0), [0, 2 * marks.HALF_AXIS * unit, 0])
    for number, mark in enumerate(found):
        entity = f"/improved/wrong/{number}"
        assert columns(entity, "Points3D:labels")[1] == [[mark.words]]
        assert columns(entity, "CoordinateFrame:frame")[1] == [[f"improved/{mark.link}"]]


def test_words_that_would_lie_upon_one_another_stand_together(robot):
    damages = (
        LinkShortening("forearm_link", 0.01),
        LinkShortening("wrist_1_link", 0.01),
        LinkShortening("wrist_2_link", 0.04),
        EncoderShift("shoulder_pan_joint", np.radians(4)),
        EncoderShift("wrist_3_joint", np.radians(3)),
    )
    found = marks.marks(robot, damages, scene.unit_of(robot.workspace))
    assert {mark.link: mark.words for mark in found if mark.words} == {
        "forearm_link": "1 cm short",
        "shoulder_link": "encoder 4 deg",
        "wrist_3_link": "wrist 1: 1 cm short\nwrist 2: 4 cm short\nwrist 3: encoder 3 deg",
    }
    assert len(found) == len(damages), "each has its colour and its axis"


def test_only_a_short_link_has_another_colour(columns):
    tint = "Asset3D:albedo_factor"
    _, tints = columns("/improved/ur10/visual_geometries/forearm_link/visual_0", tint)
    red, green, blue = colours.SHORT
    assert tints[0][0] >> 8 == red << 16 | green << 8 | blue
    with pytest.raises(KeyError):
        columns("/improved/ur10/visual_geometries/upper_arm_link/visual_0", tint)


def test_measurements_scatter_about_the_landings_and_are_enlarged_to_be_seen(recording, columns):
    training = recording[1]["improved"]
    assert training.scatter.shape == (POSES, story.REPEATED, 3)
    assert training.scatter.std() == pytest.approx(0.0002, rel=0.2)  # of 360 numbers
    assert scatter.enlarged(training) == 100
    _, lines = columns("/improved/measured", "LineStrips3D:strips", "moves")
    starts, ends = np.reshape(lines[-1], (POSES, story.REPEATED, 2, 3)).swapaxes(0, 2)
    landed = training.achieved[-1, :, :3, 3]
    assert np.allclose(starts, landed, atol=1e-6)
    assert np.allclose(ends - starts, 100 * training.scatter.swapaxes(0, 1), atol=1e-5)


def test_the_map_starts_without_corrections_and_lights_up_at_its_winner(
    controller, recording, columns
):
    training = recording[1]["improved"]
    _, arrows = columns("/improved/map/corrections", "Arrows3D:vectors", "moves")
    assert np.ptp(arrows[0]) == 0
    assert np.allclose(arrows[-1], training.cells.corrections[-1], atol=1e-6)
    misses = (training.achieved[0] - training.desired)[:, :3, 3].mean(axis=0)
    assert (
        np.mean(arrows[-1], axis=0) @ misses < -0.5 * misses @ misses
    )  # they make up for the misses
    last = controller.robot.workspace.to_poses(poses().desired[0, -1])[:3, 3]
    winner = np.linalg.norm(training.cells.centres - last, axis=-1).argmin()
    weights = training.cells.weights
    assert weights[-1].argmax() == winner and weights[-1, winner] == 1
    assert not weights[0].any()


def test_every_link_has_its_mesh(robot, columns):
    links = [
        frame.name
        for frame in robot.arm.model.frames
        if frame.name.endswith("_link") and frame.name != "ee_link"
    ]
    assert len(links) == 7
    for name in ("improved", "ritter"):
        for link in links:
            _, blobs = columns(f"/{name}/ur10/visual_geometries/{link}/visual_0", "Asset3D:blob")
            assert len(blobs[0][0]) > 10_000


def test_a_recording_says_what_it_shows(job, columns):
    def said(key):
        return columns("/__properties/run", key)[1][0][0]

    assert jobs.Recording.model_validate_json(said("job")) == job
    assert said("robot") == "ur10" and said("numpy") == np.__version__
    assert json.loads(said("damage"))[1] == "link forearm_link, shorten 4 cm"


def test_the_panel_names_the_robot_and_what_is_wrong_with_it(resolved, recording, columns):
    _, texts = columns("/about", "TextDocument:text")
    for words in (
        "UR10",
        "link forearm_link, shorten 4 cm",
        "translate 1 cm, 0 m, -2 cm",
        "noise position 0.2 mm, orientation 0.0003 rad",
        f"visits {POSES} poses",
        f"learns for {2 * ITERATIONS} moves",
        f"how far {story.REPEATED} measurements of each pose are off, 100 times enlarged",
    ):
        assert words in texts[0][0]
    _, texts = columns("/beside", "TextDocument:text")
    assert "under 2 learners" in texts[0][0] and "**Ritter**, a map: 80 moves" in texts[0][0]


@pytest.mark.parametrize("damages", [(), (Noise(0.0002, 0.0003),)], ids=["intact", "noise alone"])
def test_the_panel_of_an_undamaged_arm_speaks_of_no_damage_and_no_misses(
    resolved, recording, damages
):
    its = resolved(damages)
    told = about.panel(its, recording[1])
    assert "Nothing is wrong" in told and "damage" not in told and "miss" not in told
    assert ("noise" in told) == bool(damages)
    assert about.when(its) == ("before learning", "after learning")
    assert about.when(resolved(DAMAGES)) == ("before recalibration", "after recalibration")


def test_an_intact_arm_that_keeps_its_errors_learns_nothing_and_one_that_does_not_is_spoilt(
    resolved, recording
):
    its, learned = resolved(()), recording[1]["improved"]
    assert "although there is nothing to correct" in about.panel(its, {"improved": learned})
    history = learned.history
    nothing = replace(history, position=0 * history.position, orientation=0 * history.orientation)
    kept = replace(learned, history=nothing)
    assert "stay below 0.001 cm and 0.001°" in about.panel(its, {"improved": kept})


def test_what_is_published_is_shown(job, columns):
    for quantity, value in job.published.items():
        _, line = columns(f"/errors/{quantity}/paper", "Scalars:scalars", "moves")
        assert np.allclose(np.ravel(line), value)


@pytest.fixture
def sample(plan, tmp_path):
    """Three searches, of which the first one found the best settings, and the second the worst."""
    trials = pd.DataFrame({"search": [1, 2, 3], "initial_width": [3.8, 0.3, 1.0]})
    finals = {f"{name}/{net}": 0.3 for name in ("position", "orientation") for net in search.NETS}
    trials = trials.assign(**finals, initial_rate=0.8, final_rate=0.4, **dict.fromkeys(ERRORS, 1))
    path = tmp_path / "improved_40.csv"
    write_sample(path, plan.sample("improved_40").model_copy(update={"searches": 3}), trials)
    return path


def test_the_typical_search_is_recorded_as_the_experiment_measured_it_with_outliers_and_all(
    job, resolved, sample, tmp_path
):
    disturbed, undisturbed = resolved((*DAMAGES, *DISTURBANCES)), resolved(DAMAGES[:-1])
    scenario, other = tmp_path / "disturbed.json", tmp_path / "undisturbed.json"
    disturbed.write(scenario)
    undisturbed.write(other)
    job = job.model_copy(update={"learners": {"improved": job.learners["improved"]}})
    training = jobs.Training(
        scenario=job.scenario,
        learner=job.learners["improved"],
        seeds=5,
        first=0,
        last=15,
        measuring=job.measuring,
        throughout=True,
        seed=SEED,
    )
    history = tmp_path / "improved.parquet"
    columns, _, _ = campaign.train_seeds(training, scenario, sample)
    frame = pd.DataFrame(columns)
    frame.to_parquet(history)
    assert frame.groupby("search")["seed"].unique().map(list).tolist() == [
        [*range(first, first + 5)] for first in (0, 5, 10)
    ]
    assert typical(errors_of(frame)) == 2
    path = tmp_path / "recordings" / "links_encoders.rrd"
    with pytest.raises(BrokenRecording, match="improved after 8 moves: position_error_cm is "):
        record(path, job, other, [sample], [history])
    assert not path.exists()
    record(path, job, scenario, [sample], [history])
    check_recording(path, {"improved": frame[frame["seed"] == 10]})


def test_a_recording_that_differs_from_the_experiment_is_not_written(
    job, resolved, results, tmp_path
):
    spoilt = {name: frame.reset_index(drop=True) for name, frame in results.items()}
    measured = spoilt["ritter"].loc[3, "orientation_error_deg"]
    spoilt["ritter"].loc[3, "orientation_error_deg"] *= 1 + 1e-8
    with pytest.raises(BrokenRecording, match="ritter after 24 moves") as caught:
        write_recording(
            tmp_path / "links_encoders.rrd", job, resolved(DAMAGES), learners(job), spoilt, 0
        )
    assert f"orientation_error_deg is {measured}" in str(caught.value)
    assert str(spoilt["ritter"].loc[3, "orientation_error_deg"]) in str(caught.value)
    assert not list(tmp_path.iterdir())


def test_one_learner_other_than_the_improved_of_an_arm_described_elsewhere(
    job, robot, resolved, tmp_path
):
    folder = robot.urdf.parents[1]
    urdf = tmp_path / "my_arm" / "urdf" / "arm.urdf"
    urdf.parent.mkdir(parents=True)
    package = f"example-robot-data/robots/{folder.name}/"
    urdf.write_text(robot.urdf.read_text().replace(package, "my_arm/"))
    shutil.copytree(folder / "meshes", tmp_path / "my_arm" / "meshes")
    its = resolved(DAMAGES, urdf=str(urdf))
    job = job.model_copy(
        update={
            "learners": {"ritter": job.learners["ritter"]},
            "measuring": job.measuring.model_copy(update={"tests": 3}),
            "published": {},
        }
    )
    path = tmp_path / "links_encoders.rrd"
    measured = experiment(job, its)
    watched = write_recording(path, job, its, learners(job), measured, 0)
    check_recording(path, measured)
    entities = {chunk.entity_path for chunk in RrdReader(path).store().stream().to_chunks()}
    assert "/errors/position_error_cm/ritter" in entities
    assert "/errors/position_error_cm/paper" not in entities
    assert len(arrange(watched, robot.workspace, {}, False).root_container.contents) == 1
    motion = story.move(watched["ritter"], robot.home, 2 * ITERATIONS)
    assert motion.arrivals[0, -1] < BEFORE < motion.learning[0]
    assert motion.arrivals[1, -1] < AFTER < motion.end


def test_the_arm_moves_smoothly_and_rests_at_every_pose(robot, recording):
    training = recording[1]["improved"]
    motion = story.move(training, robot.home, 2 * ITERATIONS)
    act = len(motion.times) // 2
    for angles, stops in (
        (motion.angles[:act], training.angles[0]),
        (motion.angles[act:], training.angles[-1]),
    ):
        speed = np.abs(np.diff(angles, axis=0)).max(axis=-1)
        assert (
            speed.max() < 2 * np.pi / FRAMES_A_SECOND
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
    its = {"env": quiet(), "capture_output": True}
    compare = [PROGRAM, "rrd", "compare", "--unordered", recording[0]]
    again, other = tmp_path / "links_encoders.rrd", tmp_path / "other" / "links_encoders.rrd"
    write(again, DAMAGES)
    assert subprocess.run([*compare, again], **its).returncode == 0
    write(other, (*DAMAGES[:1], LinkShortening("forearm_link", 0.041), *DAMAGES[2:]))
    assert subprocess.run([*compare, other], **its).returncode != 0


SPOILT = {"time": {"time": 1}, "entity": {"entity": "/b"}, "value": {"value": 1.5}}


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


@pytest.mark.parametrize("spoil", ["time", "entity", "value"])
def test_a_seal_covers_times_entities_and_values(spoil, tmp_path):
    """As if another program had written the same seal over other content."""

    def fill(entity="/a", time=0, value=1.0):
        def log(recording):
            times = rr.TimeColumn("iteration", sequence=[time])
            recording.send_columns(entity, [times], rr.Scalars.columns(scalars=[value]))

        return log

    digests = []
    for name, its in (("one", {}), ("same", {}), ("other", SPOILT[spoil])):
        path = tmp_path / f"{name}.rrd"
        write_sealed(path, "its", rrb.Blueprint(), fill(**its))
        (seal,) = (
            chunk.to_record_batch().column("sha256")[0].as_py()
            for chunk in RrdReader(path).store().stream().to_chunks()
            if chunk.entity_path == SEAL
        )
        digests.append(seal)
    assert digests[0] == digests[1] != digests[2]


def test_a_recording_of_other_results_is_refused(recording, results):
    other = results["improved"].assign(
        position_error_cm=results["improved"]["position_error_cm"] + 1e-6
    )
    with pytest.raises(BrokenRecording, match="improved after 0 moves: position_error_cm is "):
        check_recording(recording[0], {"improved": other})
    with pytest.raises(BrokenRecording, match="no /errors/position_error_cm/peer"):
        check_recording(recording[0], {"peer": other})


def test_missing_meshes_leave_no_recording(write, tmp_path, monkeypatch):
    monkeypatch.setattr(meshes, "KINDS", ())
    with pytest.raises(InvalidFile, match="mesh 'package:.* is in none of its packages"):
        write(tmp_path / "bare.rrd", DAMAGES)
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
@pytest.mark.skipif(
    not DRIVERS, reason="needs a Vulkan driver, for instance Debian's mesa-vulkan-drivers"
)
def test_the_viewer_shows_the_arm_miss_and_hit(recording, tmp_path):
    before, after = tmp_path / "before.png", tmp_path / "after.png"
    take_pictures(recording[0], {before: BEFORE, after: AFTER})
    orange = []
    for png in (before, after):
        with Image.open(png) as picture:
            pixels = np.asarray(picture.convert("RGB"), int)
        assert pixels.shape[1] == 1400 and png.stat().st_size < 300_000
        red, green, blue = np.moveaxis(pixels[:, 530:], -1, 0)  # of the arm's view
        orange.append(np.sum((red > 180) & (green < 140) & (blue < 100)))  # large misses alone
    assert orange[0] > 2000 > 20 * orange[1]
    take_pictures(recording[0], {before: BEFORE}, view=ARM, window=(800, 600))
    with Image.open(before) as picture:
        assert picture.width < 520, "one view of a smaller window"


def with_deuteranopia(colour) -> np.ndarray:
    linear = DEUTERANOPIA @ (np.array(colour) / 255) ** 2.2
    return 255 * linear.clip(0, 1) ** (1 / 2.2)


def test_colours_differ_to_somebody_with_deuteranopia():
    meanings = {
        "miss": colours.FAR,
        "hit": colours.NEAR,
        "believed": colours.BELIEVED,
        "wrong": colours.WRONG,
        "measured": colours.MEASURED,
    }
    for one, other in combinations(meanings, 2):
        apart = with_deuteranopia(meanings[one]) - with_deuteranopia(meanings[other])
        assert np.linalg.norm(apart) > 60, (one, other)  # of 441


@pytest.mark.skipif(bool(DRIVERS), reason="shows what one without a Vulkan driver is told")
def test_without_a_driver_one_is_told_of_it(recording, tmp_path):
    with pytest.raises(ViewerUnavailable, match="needs a Vulkan driver"):
        take_pictures(recording[0], {tmp_path / "before.png": BEFORE})
    assert not list(tmp_path.iterdir())


def test_identification_in_a_few_moves_is_recorded_beside_the_map(job, resolved, tmp_path):
    its = resolved(DAMAGES[:3])
    job = job.model_copy(
        update={"learners": {"geometric": None} | {"improved": job.learners["improved"]}}
    )
    fresh = {
        "geometric": make_peer("geometric", 1, its.controller()),
        "improved": learner("improved"),
    }
    measured = experiment(job.model_copy(update={"learners": {"improved": None}}), its)
    path = tmp_path / "links_encoders.today.rrd"
    watched = write_recording(path, job, its, fresh, measured, 0)
    few, many = watched["geometric"], watched["improved"]
    assert list(few.history.moves) == [0, 1, 2, 3, 4, 5] and few.cells is None
    assert (few.misses[0] == many.misses[0]).all() and (few.desired == many.desired).all()
    assert few.misses[-1].max() < 1e-4 < many.misses[-1].mean()
    clock = story.move(few, its.controller().robot.home, many.history.moves[-1])
    assert clock.learning[-1] == pytest.approx(ACT + LEARNING * 5 / (2 * ITERATIONS))
    tabs = arrange(watched, its.controller().robot.workspace, {}, True).root_container
    assert len(tabs.contents) == 2 and tabs.active_tab == 1


def test_the_eye_is_on_the_side_from_which_misses_look_longest(robot):
    seen = [seen_from(robot.workspace, np.array([miss])) for miss in ((5, -5, 4.3), (5, 5, 4.3))]
    assert seen[0][1] > 0 > seen[1][1]
    for miss, eye in zip(((5, -5, 4.3), (5, 5, 4.3)), seen, strict=True):
        assert np.linalg.norm(np.cross(miss, eye)) > 0.9 * np.linalg.norm(miss)


def test_errors_are_plotted_in_what_a_person_reads():
    assert all(title.endswith(("[cm]", "[degrees]")) for title in TITLES.values())
