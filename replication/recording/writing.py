"""A recording: a run of an experiment is repeated, recorded, and compared with the experiment."""

import warnings
from collections.abc import Mapping, Sequence
from itertools import cycle
from pathlib import Path

import numpy as np
import pandas as pd
import rerun as rr
from rerun.chunk import RrdReader
from rerun.error_utils import RerunWarning

from recalib.errors import InvalidFile
from recalib.files.storage import whole
from recalib.loop.interfaces import Learner
from replication.config.damages import damages_among, disturbances_among
from replication.judgement.intervals import typical
from replication.recording import captions, colours
from replication.recording.arms import send_arms
from replication.recording.blueprint import arrange
from replication.recording.measurements import (
    send_errors,
    send_landings,
    send_map,
    send_published,
    send_scatter,
)
from replication.recording.phases import move
from replication.recording.scene import Scene, log_surroundings, send_target
from replication.recording.sight import Sight, sight_of
from replication.recording.watched import Watched, watch
from replication.scenarios.plants import Resolved
from replication.training.competitors import make_peer
from replication.training.measured import ERRORS, errors_of
from replication.training.poses import ResultPoses, Stream
from replication.training.recordings import FEW, Recording
from replication.training.settings import build_tuned


def record(
    rrd: Path, recording: Recording, scenario: Path, samples: list[Path], histories: list[Path]
) -> None:
    """Write the recording of a scenario from files: a run of a typical search.

    It is that of the first of the paper's learners. See `write_recording`.

    Args:
        samples: for each of its learners of the paper, the file of the search for it.
        histories: for each of them, the file of its training.
    """
    resolved = Resolved.read(scenario)
    papers = recording.papers()
    tables = dict(zip(papers, map(pd.read_parquet, histories), strict=True))
    errors = errors_of(next(iter(tables.values())))
    seed = typical(errors) * errors.shape[1]  # the first one of that search
    measured = {name: table[table["seed"] == seed] for name, table in tables.items()}
    searched = dict(zip(papers, samples, strict=True))
    learners = {
        name: build_tuned(learner, searched[name], measured[name]["search"].unique())
        if learner
        else make_peer(name, 1, resolved.controller().robot)
        for name, learner in recording.learners.items()
    }
    write_recording(rrd, recording, resolved, learners, measured, seed)


def write_recording(
    path: Path,
    job: Recording,
    resolved: Resolved,
    learners: Mapping[str, Learner],
    measured: Mapping[str, Mapping[str, Sequence]],
    seed: int,
) -> dict[str, Watched]:
    """Train learners on a scenario's robot, and write what one would have seen.

    The file appears whole or not at all, and not before it was compared with the experiment.

    Args:
        learners: its learners, fresh ones of one run.
        measured: for each of the paper's learners, the columns of its history with this seed in the
            experiment.
        seed: of the poses that are visited.

    Returns what was watched, by learner. Raises InvalidFile where a mesh of the robot is not found,
    or where the experiment measured anything else than what was watched.
    """
    controller, watched = resolved.controller(), {}
    for name, learner in learners.items():
        measure_at = list(range(FEW + 1))  # of today's: after each move
        if rules := job.learners[name]:
            measure_at = job.measuring.during(rules.iterations)
        poses = Stream.SCENARIO.draw(
            job.seed, [seed], measure_at[-1], job.measuring.tests, scenario=job.scenario
        )
        plant = resolved.plant(controller, job.seed, [seed])
        watched[name] = watch(controller, plant, learner, ResultPoses.only(poses), measure_at)
        if name in measured:
            _compare(path, name, watched[name].history.columns(), measured[name])
    main = next(iter(watched.values()))
    misses = (main.achieved[0] - main.desired)[:, :3, 3]
    sight = sight_of(controller.robot.workspace, misses)
    rr.set_strict_mode(True)  # a mere warning would leave a hole in the recording
    with whole(path) as temporary:
        # without the properties that Rerun would add by itself: one is the time of writing
        rec = rr.RecordingStream("recalib", recording_id=path.stem, send_properties=False)
        rec.save(temporary, default_blueprint=arrange(watched, sight, job.published))
        _fill(rec, path.stem, job, resolved, watched, sight)
        rec.disconnect()
        check_end(temporary)
    return watched


def _compare(path: Path, learner: str, shown: Mapping, measured: Mapping) -> None:
    """Raise InvalidFile where something else was watched than what had been measured."""
    rows = {moves: row for row, moves in enumerate(shown["moves"])}
    for row, moves in enumerate(measured["moves"]):
        where = f"{learner} after {moves} moves"
        if moves not in rows:
            raise InvalidFile(path, f"{where} was measured, but is not shown")
        for quantity in ERRORS:
            ours = shown[quantity][rows[moves]]
            theirs = np.asarray(measured[quantity])[row]
            if not np.isclose(ours, theirs, rtol=1e-9, atol=1e-12):
                raise InvalidFile(
                    path, f"{where}: {quantity} is {ours}, but was measured as {theirs}"
                )


def _fill(
    rec: rr.RecordingStream,
    title: str,
    job: Recording,
    resolved: Resolved,
    watched: Mapping[str, Watched],
    sight: Sight,
) -> None:
    robot, damages = resolved.controller().robot, damages_among(resolved.damages)
    main = next(iter(watched.values()))
    most = max(its.history.iterations[-1] for its in watched.values())
    texts = {"about": captions.about(resolved, watched), "beside": captions.beside(watched)}
    rec.send_recording_name(title)
    rec.send_property("run", rr.AnyValues(**captions.properties(job, resolved)))
    log_surroundings(rec, robot.workspace, main.desired, texts)
    for colour, (name, its) in zip(cycle(colours.LEARNERS), watched.items(), strict=False):
        motion = move(its.angles, its.history.iterations, robot.home, most)
        scene = Scene(rec, name, robot.workspace, its, motion, sight)
        if its is main:
            send_published(scene, job.published)
        send_arms(scene, robot, damages)
        send_target(scene, captions.progress(resolved, its))
        send_errors(scene, colour)
        send_landings(scene)
        if disturbances_among(resolved.damages):
            send_scatter(scene)
        if its.cells:
            send_map(scene, its.cells)


def check_end(path: Path) -> None:
    """Raise InvalidFile where a file ends too early: to Rerun that is a mere warning."""
    try:
        with warnings.catch_warnings(action="error", category=RerunWarning):
            RrdReader(path)
    except (RerunWarning, RuntimeError) as error:
        raise InvalidFile(path, str(error)) from error
