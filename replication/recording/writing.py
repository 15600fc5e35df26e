"""Recordings: trainings are repeated and watched, and must be those of the histories."""

import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import rerun as rr
from rerun.chunk import RrdReader
from rerun.error_utils import RerunWarning

from recalib.errors import InvalidFile
from recalib.files.storage import whole
from replication.config.damages import damages_among
from replication.config.study import Study
from replication.recording import captions
from replication.recording.arms import send_arms
from replication.recording.blueprint import arrange
from replication.recording.measurements import send_errors, send_landings, send_map
from replication.recording.phases import move
from replication.recording.recorded import recorded_history, typical_seed
from replication.recording.scene import Scene, log_legend, log_surroundings, send_target
from replication.recording.sight import sight_of
from replication.recording.watched import Watched, watch
from replication.scenarios.plants import Resolved
from replication.training.measured import ERRORS
from replication.training.plan import leading
from replication.training.poses import Stream
from replication.training.tuned import Tuned


def record(
    study: Study,
    scenarios: Sequence[Path],
    settings: Sequence[Path],
    histories: Sequence[Path],
    recordings: Sequence[Path],
) -> None:
    """Write a recording of each scenario: of the typical training of the learner of Figure 1.

    Args:
        scenarios: files of the scenarios, those of `recorded_places`.
        settings: files with widths and rates.
        histories: files of the learner's trainings, one for each scenario.
        recordings: files that are written, one for each scenario.

    Raises InvalidFile: a mesh of the robot is not found, or a history says something else than
    what was watched.
    """
    tuned = Tuned(study, settings)
    for file, path, rrd in zip(scenarios, histories, recordings, strict=True):
        resolved, table = Resolved.read(file), recorded_history(study, path)
        seed = typical_seed(table)
        watched = watch_training(study, resolved, tuned, seed)
        _compare(path, watched, table[table["seed"] == seed])
        write_recording(rrd, resolved, leading(study).learner, watched)


def watch_training(study: Study, resolved: Resolved, tuned: Tuned, seed: int) -> Watched:
    """The training with a seed."""
    (learner, iterations, _), controller = leading(study), resolved.controller()
    tests, scenario = study.training.tests, resolved.scenario
    return watch(
        controller,
        resolved.plant(controller, study.seed, [seed]),
        tuned.learner(learner, iterations, 1),
        Stream.SCENARIO.draw(study.seed, [seed], iterations, tests, scenario=scenario),
        study.training.during(iterations),
    )


def _compare(path: Path, watched: Watched, history: pd.DataFrame) -> None:
    """Raise InvalidFile where a history says something else than what was watched."""
    shown = pd.DataFrame(watched.history.columns())
    for column in ("iteration", *ERRORS):
        ours, theirs = shown[column].to_numpy(), history[column].to_numpy()
        if len(ours) != len(theirs) or not np.allclose(ours, theirs, rtol=1e-9, atol=1e-12):
            raise InvalidFile(path, f"its {column} is not that of the same training now")


def write_recording(path: Path, resolved: Resolved, learner: str, watched: Watched) -> None:
    """Write what was watched of a learner on a scenario's robot.

    Raises InvalidFile: a mesh of the robot is not found, or the file ends too early.
    """
    robot, damages = resolved.controller().robot, damages_among(resolved.damages)
    sight = sight_of(robot.workspace, (watched.achieved[0] - watched.desired)[:, :3, 3])
    motion = move(watched.angles, watched.history.iterations, robot.home)
    rr.set_strict_mode(True)  # a mere warning would leave a hole in the recording
    with whole(path) as temporary:
        # without the properties that Rerun would add by itself: one is the time of writing
        rec = rr.RecordingStream("recalib", recording_id=path.stem, send_properties=False)
        rec.save(temporary, default_blueprint=arrange(learner, watched, sight))
        rec.send_recording_name(path.stem)
        rec.send_property("run", rr.AnyValues(**captions.properties(resolved)))
        description = captions.description(resolved, watched)
        log_legend(rec, sight, captions.legend(resolved))
        scene = Scene(rec, learner, robot, watched, motion, sight)
        log_surroundings(scene, description)
        send_arms(scene, damages)
        send_target(scene, captions.progress(resolved, watched))
        send_errors(scene)
        send_landings(scene)
        send_map(scene)
        rec.disconnect()
        check_end(temporary)


def check_end(path: Path) -> None:
    """Raise InvalidFile where a file ends too early: to Rerun that is a mere warning."""
    try:
        with warnings.catch_warnings(action="error", category=RerunWarning):
            RrdReader(path)
    except (RerunWarning, RuntimeError) as error:
        raise InvalidFile(path, str(error)) from error
