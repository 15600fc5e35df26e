"""Writing a recording: a run of an experiment once more, watched."""

from collections.abc import Mapping, Sequence
from itertools import cycle
from pathlib import Path

import pandas as pd
import rerun as rr

from recalib.learners.hierarchical import HierarchicalLearner
from recalib.storage import whole
from recalib.study import jobs
from recalib.study.configuration.damages import damages_among
from recalib.study.experiments import campaign
from recalib.study.experiments.settings import build_tuned
from recalib.study.measured import errors_of
from recalib.study.plants import Resolved
from recalib.study.recording import about, arms, scene, story
from recalib.study.recording.blueprint import arrange
from recalib.study.recording.seal import check_errors, check_recording, write_sealed
from recalib.study.statistics import typical


def record(
    path: str | Path,
    job: jobs.Recording,
    scenario: str | Path,
    samples: Sequence[str | Path],
    histories: Sequence[str | Path],
) -> None:
    """Write the recording of a scenario from files: a run of the first learner's typical search.

    See `write_recording`.

    Args:
        scenario: file of the scenario as resolved.
        samples: for each learner of the job, the file of the search for it.
        histories: for each learner of the job, the file of its training.
    """
    tables = dict(zip(job.learners, map(pd.read_parquet, histories), strict=True))
    errors = errors_of(next(iter(tables.values())))
    seed = typical(errors) * errors.shape[1]  # the first one of that search
    measured = {name: table[table["seed"] == seed] for name, table in tables.items()}
    learners = {
        name: build_tuned(learner, sample, measured[name]["search"].unique())
        for (name, learner), sample in zip(job.learners.items(), samples, strict=True)
    }
    write_recording(Path(path), job, Resolved.read(scenario), learners, measured, seed)


def write_recording(
    path: Path,
    job: jobs.Recording,
    resolved: Resolved,
    learners: Mapping[str, HierarchicalLearner],
    measured: Mapping[str, Mapping[str, Sequence]],
    seed: int,
) -> dict[str, story.Watched]:
    """Train learners on a scenario's robot, and write what one would have seen.

    The file appears whole or not at all, and not before it was compared with the experiment.

    Args:
        job: its learners have the same number of iterations.
        learners: fresh learners of one run, by name. The arm is moved by the first of them.
        measured: for each learner, the columns of its history with this seed in the experiment.
        seed: of the poses that are visited.

    Returns what was watched, by learner. Raises BrokenRecording where the robot's meshes are not
    found, and where the experiment measured anything else than what was watched.
    """
    iterations = next(iter(job.learners.values())).iterations
    desired = campaign.desired_poses(job.seed, job.scenario, [seed], iterations)[0]
    tests = campaign.test_poses(job.seed, job.scenario, [seed], job.measuring.tests)[0]
    measure_at = campaign.measured_at(job.measuring, iterations)
    controller = resolved.controller()
    watched = {}
    for name, learner in learners.items():
        plant = resolved.plant(controller, job.seed, [seed])
        watched[name] = story.watch(controller, plant, learner, desired, tests, measure_at)
        check_errors(path, name, watched[name].history.columns(), measured[name])

    robot, main = controller.robot, next(iter(watched.values()))
    motion, unit = story.move(main, robot.home), scene.unit_of(robot.workspace)

    def fill(rec: rr.RecordingStream) -> None:
        rec.send_recording_name(job.scenario)
        rec.send_property("run", rr.AnyValues(**about.properties(job, resolved)))
        panel = about.panel(resolved, watched)
        scene.log_surroundings(rec, robot.workspace, main.desired, panel)
        arms.send_arms(rec, robot, damages_among(resolved.damages), main, motion)
        scene.send_target(rec, robot.workspace, main, motion)
        scene.send_published(rec, job.published, main, motion)
        colours = cycle(scene.LEARNER_COLOURS)
        for colour, (name, each) in zip(colours, watched.items(), strict=False):
            scene.send_errors(rec, name, colour, each, motion)
            scene.send_landings(rec, name, unit, each, motion)
            scene.send_map(rec, name, unit, each, motion)

    rr.set_strict_mode(True)  # a mere warning would leave a hole in the recording
    with whole(path) as temporary:
        blueprint = arrange(watched, robot.workspace, job.published)
        write_sealed(temporary, job.scenario, blueprint, fill)
        check_recording(temporary, {name: each.history.columns() for name, each in watched.items()})
    return watched
