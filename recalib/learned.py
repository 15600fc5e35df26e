"""Files of what was learned: enough to go on or to correct commands elsewhere, on the same robot.

A file is NumPy's .npz. Its array `header` holds JSON: the format's version, the kind of learner and
what it was made with, and the robot. All other arrays are named RUN/GROUP/NAME.
"""

import json
import math
import zipfile
from collections.abc import Iterable, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from recalib.errors import InvalidFile, InvalidSetting, OtherRobot, UnknownName
from recalib.interfaces import Savable, State
from recalib.storage import whole

# To join files takes no robot: what moves one is imported where it is used.
if TYPE_CHECKING:
    from recalib.nominal.controller import Controller
    from recalib.nominal.robots import Robot

FORMAT, VERSION = "recalib learner", 1
KINDS = "hierarchical", "polynomial", "gaussian_process", "geometric", "hybrid"
ALIKE = 1e-9  # m, rad: numbers of two robots that differ by less are the same
PROBES = 8  # joint angles at which the kinematics of two robots are compared

Path = str | PathLike


def save(path: Path, learner: Savable, robot: "Robot") -> None:
    """Write what a learner has learned on a robot.

    Raises UnknownName (a learner of no known kind) and InvalidSetting (runs with schedules of their
    own).
    """
    kind = getattr(learner, "kind", type(learner).__name__)
    if kind not in KINDS:
        raise UnknownName("kind of learner to save", kind, KINDS)
    header = {
        "format": FORMAT,
        "version": VERSION,
        "kind": kind,
        "settings": learner.settings(),
        "robot": _identity(robot),
    }
    _write(path, header, learner.state())


def load(path: Path, robot: "Robot", run: int | None = None) -> Savable:
    """The learner that `save` wrote, for the same robot.

    Args:
        run: the one to load; all of them unless given.

    Raises InvalidFile (not whole, or no such file), OtherRobot, and InvalidSetting (no such run).
    """
    header, states = _read(path)
    if differences := _differences(header["robot"], _identity(robot)):
        raise OtherRobot(path, differences)
    if run is not None:
        if not 0 <= run < len(states):
            raise InvalidSetting("run", run, f"0 to {len(states) - 1}")
        states = [states[run]]
    learner = _build(header["kind"], header["settings"], len(states), robot)
    learner.restore(states)
    return learner


def join(path: Path, parts: Iterable[Path]) -> None:
    """Write one file with the runs of several, of the same kind of learner on the same robot.

    Raises InvalidFile.
    """
    header, states = None, []
    for part in parts:
        its_header, its_states = _read(part)
        if its_header != (header := header or its_header):
            raise InvalidFile(part, "it is of another learner or robot than the first")
        states += its_states
    _write(path, header, states)


def _build(kind: str, settings: Mapping[str, Any], runs: int, robot: "Robot") -> Savable:
    # Imported where they are used: the maps need not wait for scikit-learn.
    match kind:
        case "hierarchical":
            from recalib.learners.hierarchical import HierarchicalLearner, Rules, Schedule

            rules = settings["rules"]
            nets = {name: tuple(rules[name]) for name in ("supernet", "subnet")}
            return HierarchicalLearner(
                runs, Rules(**rules | nets), Schedule(**settings["schedule"])
            )
        case "polynomial":
            from recalib.learners.polynomial import PolynomialLearner

            return PolynomialLearner(runs, **settings)
        case "gaussian_process":
            from recalib.learners.gaussian_process import GaussianProcessLearner

            return GaussianProcessLearner(runs)
        case "geometric":
            from recalib.learners.geometric import GeometricLearner

            return GeometricLearner(runs, _controller(robot))
        case "hybrid":
            from recalib.learners.hybrid import HybridLearner

            return HybridLearner(runs, _controller(robot))
    raise UnknownName("kind of learner", kind, KINDS)


def _controller(robot: "Robot") -> "Controller":
    """The one behind which the learner learned, whose singularity margin was accepted then."""
    from recalib.nominal.controller import Controller

    return Controller(robot, greatest_condition=math.inf)


def _identity(robot: "Robot") -> dict[str, Any]:
    """What tells a robot from others, in the types of JSON: what it does, not what it is called."""
    joints = np.arange(len(robot.joints)) + 1
    angles = np.sin(np.outer(np.arange(PROBES) + 1, joints))  # rad, a mixture of all joints
    numbers = {
        "kinematics": robot.arm.forward(angles),
        "home": robot.home,
        "workspace": np.append(robot.workspace.centre, robot.workspace.half_ranges),
    }
    names = {"joints": [*robot.joints], "tool": robot.arm.tool}
    return names | {name: value.ravel().tolist() for name, value in numbers.items()}


def _differences(learned: Mapping[str, Any], here: Mapping[str, Any]) -> list[str]:
    """What differs between the identities of two robots."""
    differences = [
        f"its {name} {'are' if name == 'joints' else 'is'} {learned[name]}, not {here[name]}"
        for name in ("joints", "tool")
        if learned[name] != here[name]
    ]
    if learned["joints"] != here["joints"]:
        return differences
    for name in ("kinematics", "home", "workspace"):
        gap = np.abs(np.subtract(learned[name], here[name])).max()
        if not gap <= ALIKE:
            differences.append(f"its {name} differs by up to {gap:.3g} m or rad")
    return differences


def _write(path: Path, header: Mapping[str, Any], states: Sequence[State]) -> None:
    arrays = {}
    for run, state in enumerate(states):
        arrays |= flat(state, f"{run}/")
    with whole(path) as temporary:
        np.savez(temporary, header=json.dumps(header), **arrays)


def _read(path: Path) -> tuple[dict[str, Any], list[State]]:
    try:
        with open(path, "rb") as stream, np.load(stream) as file:
            arrays = {name: file[name][()] for name in file.files}
        header = json.loads(str(arrays.pop("header")))
        found = header["format"], header["version"]
    except (AttributeError, EOFError, KeyError, TypeError, ValueError, zipfile.BadZipFile):
        raise InvalidFile(path, "it is not whole, or not written by recalib.save") from None
    if found != (FORMAT, VERSION):
        raise InvalidFile(path, f"it is of format {found}; valid: {(FORMAT, VERSION)}")
    state = _nested(arrays)
    return header, [state[str(run)] for run in range(len(state))]


def flat(state: State, prefix: str = "") -> dict[str, np.ndarray]:
    """The arrays of a state by their paths, such as position/theta."""
    arrays = {}
    for name, value in state.items():
        if isinstance(value, Mapping):
            arrays |= flat(value, f"{prefix}{name}/")
        elif value is not None:
            arrays[prefix + name] = np.asarray(value)
    return arrays


def _nested(arrays: Mapping[str, np.ndarray]) -> State:
    state: dict[str, Any] = {}
    for path, value in arrays.items():
        *groups, name = path.split("/")
        group = state
        for each in groups:
            group = group.setdefault(each, {})
        group[name] = value
    return state
