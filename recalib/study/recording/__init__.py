"""Recordings of an arm before, during and after its recalibration. This package alone imports rerun."""

from collections.abc import Mapping, Sequence
from itertools import cycle
from pathlib import Path

import numpy as np
import rerun as rr

from recalib.damaged.damage import Damage, apply
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.nominal.controller import Controller
from recalib.storage import whole
from recalib.study.recording import arms, scene, story
from recalib.study.recording.blueprint import arrange
from recalib.study.recording.picture import ViewerUnavailable, take_pictures
from recalib.study.recording.seal import BrokenRecording, check_recording, write_sealed
from recalib.study.recording.story import AFTER, BEFORE, Training

__all__ = [
    "AFTER",
    "BEFORE",
    "BrokenRecording",
    "ViewerUnavailable",
    "check_recording",
    "take_pictures",
    "write_recording",
]

ABOUT = """\
**The grey arm is the real one**, with the damage that gives the recording its name, and the blue ghost is the intact \
arm that its controller believes in, which is always exactly where it was sent.

**Press play** (space bar): the arm visits {poses} poses (white axes) and misses them by the coloured lines (orange: \
10 cm, green: 1 mm), it learns for {iterations} iterations, and it visits them again.

**Now it hits, and the ghost misses**: each command was moved to make up for the damage, as told by a map whose cells \
(dots) light up around the one that learned last and whose corrections grow as violet arrows.

**Choose the timeline `iteration`** at the bottom left to drag through the learning alone, or the second tab to \
compare learners.
"""


def write_recording(
    path: Path,
    damages: Sequence[Damage],
    controller: Controller,
    learners: Mapping[str, HierarchicalLearner],
    desired: np.ndarray,
    tests: np.ndarray,
    measure_at: Sequence[int],
    properties: Mapping[str, str],
) -> dict[str, Training]:
    """Train learners on a damaged robot, and write what one would have seen. The file appears whole or not at all.

    Args:
        path: of the recording, `<scenario>.rrd`: its stem becomes the recording's name and identity.
        damages: done to the controller's robot.
        learners: fresh learners of one run, by name. The arm is moved by the first of them.
        desired: (iteration, 6) poses to learn from, coordinates of the workspace.
        tests: (test, 6) poses to measure the errors at; the arm visits the first few.
        measure_at: numbers of iterations after which to measure, from 0 to the number of iterations.
        properties: what the recording says about itself beside its name: damage, robot, seed, versions ...

    Returns what was watched, by learner. Raises BrokenRecording where the robot's meshes are not found.
    """
    robot, damaged = controller.robot, apply(controller.robot, damages)
    shown = story.visiting_order(tests[: story.POSES])
    trainings = {
        name: story.watch(controller, damaged, learner, desired, tests, shown, measure_at)
        for name, learner in learners.items()
    }
    main = next(iter(trainings.values()))
    motion, unit = story.move(main, robot.home), scene.unit_of(robot.workspace)

    def fill(rec: rr.RecordingStream) -> None:
        rec.send_recording_name(path.stem)
        rec.send_property("run", rr.AnyValues(scenario=path.stem, **properties))
        about = ABOUT.format(poses=len(shown), iterations=len(desired))
        scene.log_surroundings(rec, robot.workspace, main.desired, about)
        arms.send_arms(rec, robot, damages, main, motion)
        scene.send_target(rec, robot.workspace, main, motion)
        scene.send_paper(rec, main, motion)
        for colour, (name, training) in zip(
            cycle(scene.LEARNER_COLOURS), trainings.items(), strict=False
        ):
            scene.send_errors(rec, name, colour, training, motion)
            scene.send_landings(rec, name, unit, training, motion)
            scene.send_map(rec, name, unit, training, motion)

    rr.set_strict_mode(True)  # a mere warning would leave a hole in the recording
    with whole(path) as temporary:
        write_sealed(temporary, path.stem, arrange(trainings, robot.workspace), fill)
        check_recording(
            temporary, {name: training.history.columns() for name, training in trainings.items()}
        )
    return trainings
