"""Recordings: trainings are repeated and watched, and must be those of the histories."""

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
from replication.config.study import Study
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
from replication.recording.recorded import (
    MOVES,
    TODAYS,
    published_errors,
    recorded_history,
    recorded_iterations,
    recorded_learners,
    typical_seed,
)
from replication.recording.scene import Scene, log_legend, log_surroundings, send_target
from replication.recording.sight import sight_of
from replication.recording.watched import Watched, watch
from replication.scenarios.plants import Resolved
from replication.training.competitors import make_peer
from replication.training.measured import ERRORS
from replication.training.poses import Stream
from replication.training.tuned import Tuned


def record(
    study: Study,
    scenarios: Sequence[Path],
    settings: Sequence[Path],
    histories: Sequence[Path],
    recordings: Sequence[Path],
) -> None:
    """Write a recording of each scenario: of one training of each of `recorded_learners`.

    It is the training with the seed that is typical of the first of them. In the study's own
    scenario, one of today's learners is watched, too.

    Args:
        scenarios: files of the scenarios, those of `recorded_places`.
        settings: files with widths and rates.
        histories: files of the trainings of all learners in the first scenario, then in the second
            one, and so on.
        recordings: files that are written, one for each scenario.

    Raises InvalidFile: a mesh of the robot is not found, or a history says something else than
    what was watched.
    """
    tuned, names = Tuned(study, settings), recorded_learners(study)
    for number, (file, rrd) in enumerate(zip(scenarios, recordings, strict=True)):
        files = histories[number * len(names) :][: len(names)]
        tables = [recorded_history(study, path) for path in files]
        resolved, seed = Resolved.read(file), typical_seed(tables[0])
        watched = watch_all(study, resolved, tuned, seed)
        for name, path, table in zip(names, files, tables, strict=True):
            _compare(path, watched[name], table[table["seed"] == seed])
        write_recording(rrd, resolved, watched, published_errors(study, resolved.scenario))


def watch_all(study: Study, resolved: Resolved, tuned: Tuned, seed: int) -> dict[str, Watched]:
    """The trainings of all learners with a seed."""
    iterations, controller = recorded_iterations(study), resolved.controller()
    learners: dict[str, tuple[Learner, Sequence[int]]] = {
        name: (tuned.learner(name, iterations, 1), study.training.during(iterations))
        for name in recorded_learners(study)
    }
    if resolved.scenario == study.scenario:
        learners[TODAYS] = make_peer(TODAYS, 1, controller.robot), range(MOVES + 1)
    found = {}
    for name, (learner, measure_at) in learners.items():
        tests, scenario = study.training.tests, resolved.scenario
        poses = Stream.SCENARIO.draw(study.seed, [seed], measure_at[-1], tests, scenario=scenario)
        plant = resolved.plant(controller, study.seed, [seed])
        found[name] = watch(controller, plant, learner, poses, measure_at)
    return found


def _compare(path: Path, watched: Watched, history: pd.DataFrame) -> None:
    """Raise InvalidFile where a history says something else than what was watched."""
    shown = pd.DataFrame(watched.history.columns())
    for column in ("iteration", *ERRORS):
        ours, theirs = shown[column].to_numpy(), history[column].to_numpy()
        if len(ours) != len(theirs) or not np.allclose(ours, theirs, rtol=1e-9, atol=1e-12):
            raise InvalidFile(path, f"its {column} is not that of the same training now")


def write_recording(
    path: Path,
    resolved: Resolved,
    watched: Mapping[str, Watched],
    published: Mapping[str, float],
) -> None:
    """Write what was watched of learners on a scenario's robot.

    Args:
        published: initial errors by quantity, if there are any.

    Raises InvalidFile: a mesh of the robot is not found, or the file ends too early.
    """
    robot, damages = resolved.controller().robot, damages_among(resolved.damages)
    main = next(iter(watched.values()))
    sight = sight_of(robot.workspace, (main.achieved[0] - main.desired)[:, :3, 3])
    most = max(its.history.iterations[-1] for its in watched.values())
    rr.set_strict_mode(True)  # a mere warning would leave a hole in the recording
    with whole(path) as temporary:
        # without the properties that Rerun would add by itself: one is the time of writing
        rec = rr.RecordingStream("recalib", recording_id=path.stem, send_properties=False)
        rec.save(temporary, default_blueprint=arrange(watched, sight, published))
        rec.send_recording_name(path.stem)
        rec.send_property("run", rr.AnyValues(**captions.properties(resolved)))
        texts = {"about": captions.about(resolved, watched), "beside": captions.beside(watched)}
        log_surroundings(rec, robot.workspace, main.desired, texts)
        log_legend(rec, sight, captions.legend(resolved))
        for colour, (name, its) in zip(cycle(colours.LEARNERS), watched.items(), strict=False):
            motion = move(its.angles, its.history.iterations, robot.home, most)
            scene = Scene(rec, name, robot.workspace, its, motion, sight)
            if its is main:
                send_published(scene, published)
            send_arms(scene, robot, damages)
            send_target(scene, captions.progress(resolved, its))
            send_errors(scene, colour)
            send_landings(scene)
            if disturbances_among(resolved.damages):
                send_scatter(scene)
            if its.cells:
                send_map(scene, its.cells)
        rec.disconnect()
        check_end(temporary)


def check_end(path: Path) -> None:
    """Raise InvalidFile where a file ends too early: to Rerun that is a mere warning."""
    try:
        with warnings.catch_warnings(action="error", category=RerunWarning):
            RrdReader(path)
    except (RerunWarning, RuntimeError) as error:
        raise InvalidFile(path, str(error)) from error
