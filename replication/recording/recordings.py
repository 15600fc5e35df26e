"""Write recordings: repeat trainings, check them against their histories, and record them."""

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
from replication.recording.blueprint import arrange, sight_of
from replication.recording.both_arms import send_arms
from replication.recording.phases import move
from replication.recording.recorded import recorded_history, typical_seed
from replication.recording.scene import Scene, log_surroundings, send_learning, send_target
from replication.recording.watched import Watched, watch
from replication.scenarios.plants import Resolved
from replication.training.measured import ERRORS
from replication.training.plan import leading
from replication.training.tuned import Tuned


def record(
    study: Study,
    scenarios: Sequence[Path],
    settings: Sequence[Path],
    histories: Sequence[Path],
    recordings: Sequence[Path],
) -> None:
    """Write a recording of a typical training of Figure 1's learner in each scenario.

    `scenarios`, `histories` and `recordings` are files, one for each of the `recorded_places`.

    Raises InvalidFile if a mesh of the robot is not found, or if a history differs from the
    repeated training.
    """
    tuned = Tuned(study, settings)
    for file, path, rrd in zip(scenarios, histories, recordings, strict=True):
        resolved, table = Resolved.read(file), recorded_history(study, path)
        seed = typical_seed(table)
        watched = watch(study, resolved, tuned, seed)
        _compare(path, watched, table[table["seed"] == seed])
        write_recording(rrd, resolved, leading(study).learner, watched)


def _compare(path: Path, watched: Watched, history: pd.DataFrame) -> None:
    """Raise InvalidFile if a history differs from the repeated training."""
    shown = pd.DataFrame(watched.history.columns())
    for column in ("iteration", *ERRORS):
        ours, theirs = shown[column].to_numpy(), history[column].to_numpy()
        if len(ours) != len(theirs) or not np.allclose(ours, theirs, rtol=1e-9, atol=1e-12):
            raise InvalidFile(path, f"its {column} differs from that of the repeated training")


def write_recording(path: Path, resolved: Resolved, learner: str, watched: Watched) -> None:
    """Write the recording of a learner on a scenario's robot.

    Raises InvalidFile if a mesh of the robot is not found, or if the file is truncated.
    """
    robot, damages = resolved.controller().robot, damages_among(resolved.damages)
    sight = sight_of(robot.workspace, (watched.achieved[0] - watched.desired)[:, :3, 3])
    motion = move(watched.angles, watched.history.iterations, robot.home)
    rr.set_strict_mode(True)  # errors instead of warnings and missing data
    with whole(path) as temporary:
        # without Rerun's own properties, such as the time of writing
        rec = rr.RecordingStream("recalib", recording_id=path.stem, send_properties=False)
        rec.save(temporary, default_blueprint=arrange(learner, watched, sight))
        rec.send_recording_name(path.stem)
        rec.send_property("run", rr.AnyValues(**captions.properties(resolved)))
        scene = Scene(rec, learner, robot, watched, motion, sight)
        description = captions.description(resolved, watched)
        log_surroundings(scene, description, captions.legend(resolved))
        send_arms(scene, damages)
        send_target(scene, captions.progress(resolved, watched))
        send_learning(scene)
        rec.disconnect()
        check_end(temporary)


def check_end(path: Path) -> None:
    """Raise InvalidFile if a file is truncated, for which Rerun only issues a warning."""
    try:
        with warnings.catch_warnings(action="error", category=RerunWarning):
            RrdReader(path)
    except (RerunWarning, RuntimeError) as error:
        raise InvalidFile(path, str(error)) from error
