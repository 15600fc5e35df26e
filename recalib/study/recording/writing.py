"""Writing a recording: a run of an experiment once more, watched."""

from collections.abc import Mapping, Sequence
from itertools import cycle
from pathlib import Path

import rerun as rr

from recalib.interfaces import Learner
from recalib.storage import whole
from recalib.study import jobs
from recalib.study.configuration.damages import damages_among, disturbances_among
from recalib.study.experiments import campaign
from recalib.study.experiments.poses import Stream
from recalib.study.plants import Resolved
from recalib.study.recording import about, arms, colours, corrections, errors, scatter, scene, story
from recalib.study.recording.blueprint import arrange
from recalib.study.recording.seal import check_errors, check_recording, write_sealed


def write_recording(
    path: Path,
    job: jobs.Recording,
    resolved: Resolved,
    learners: Mapping[str, Learner],
    measured: Mapping[str, Mapping[str, Sequence]],
    seed: int,
) -> dict[str, story.Watched]:
    """Train learners on a scenario's robot, and write what one would have seen.

    The file appears whole or not at all, and not before it was compared with the experiment.

    Args:
        job: what is recorded.
        learners: its learners, fresh ones of one run.
        measured: for each of the paper's learners, the columns of its history with this seed in the
            experiment.
        seed: of the poses that are visited.

    Returns what was watched, by learner. Raises InvalidFile where a mesh of the robot is not found,
    BrokenRecording where the experiment measured anything else than what was watched.
    """
    controller, watched = resolved.controller(), {}
    for name, learner in learners.items():
        measure_at = _measured_at(job, name)
        poses = Stream.SCENARIO.draw(
            job.seed, [seed], measure_at[-1], job.measuring.tests, scenario=job.scenario
        )
        plant = resolved.plant(controller, job.seed, [seed])
        watched[name] = story.watch(controller, plant, learner, poses, measure_at)
        if name in measured:
            check_errors(path, name, watched[name].history.columns(), measured[name])

    robot, most = controller.robot, max(each.history.moves[-1] for each in watched.values())
    unit, damages = scene.unit_of(robot.workspace), damages_among(resolved.damages)
    disturbed = disturbances_among(resolved.damages) is not None
    texts = {"about": about.panel(resolved, watched), "beside": about.beside(watched)}

    def fill(rec: rr.RecordingStream) -> None:
        rec.send_recording_name(path.stem)
        rec.send_property("run", rr.AnyValues(**about.properties(job, resolved)))
        main = next(iter(watched.values()))
        scene.log_surroundings(rec, robot.workspace, main.desired, texts)
        errors.send_published(rec, job.published, main, story.move(main, robot.home, most))
        for colour, (name, each) in zip(cycle(colours.LEARNERS), watched.items(), strict=False):
            shown = each, story.move(each, robot.home, most)
            arms.send_arms(rec, robot, damages, name, *shown)
            scene.send_target(rec, robot.workspace, name, about.when(resolved), *shown)
            errors.send_errors(rec, name, colour, *shown)
            scene.send_landings(rec, name, unit, *shown)
            if disturbed:
                scatter.send_scatter(rec, name, unit, *shown)
            if each.cells:
                corrections.send_map(rec, name, unit, each.cells, *shown)

    rr.set_strict_mode(True)  # a mere warning would leave a hole in the recording
    with whole(path) as temporary:
        blueprint = arrange(watched, robot.workspace, job.published, not all(job.learners.values()))
        write_sealed(temporary, path.stem, blueprint, fill)
        check_recording(temporary, {name: each.history.columns() for name, each in watched.items()})
    return watched


def _measured_at(job: jobs.Recording, name: str) -> Sequence[int]:
    """The iterations of a learner after which it is measured: today's after each of its moves."""
    learner = job.learners[name]
    if learner:
        return campaign.measured_at(job.measuring, learner.iterations)
    return range(job.moves + 1)
