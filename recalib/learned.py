"""Files of what was learned: enough to go on or to correct commands elsewhere, on the same robot.

`recalib.loading` makes learners of them again.

A file is NumPy's .npz. Its array `header` holds JSON: the format's version, the kind of learner and
what it was made with, and the robot. All other arrays are named RUN/GROUP/NAME.
"""

import json
import zipfile
from collections.abc import Iterable, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from recalib.errors import InvalidFile, UnknownName
from recalib.interfaces import Savable, State
from recalib.storage import whole

if TYPE_CHECKING:  # to join files takes no robot
    from recalib.nominal.robots import Robot

FORMAT, VERSION = "recalib learner", 2
KINDS = "hierarchical", "polynomial", "gaussian_process", "geometric", "hybrid"
ALIKE = 1e-9  # m, rad: numbers of two robots that differ by less are the same
PROBES = 8  # joint angles at which the kinematics of two robots are compared

Path = str | PathLike


def save(path: Path, learner: Savable, robot: "Robot") -> None:
    """Write what a learner has learned on a robot.

    Raises UnknownName (a learner of no known kind).
    """
    kind = getattr(learner, "kind", type(learner).__name__)
    if kind not in KINDS:
        raise UnknownName("kind of learner to save", kind, KINDS)
    header = {
        "format": FORMAT,
        "version": VERSION,
        "kind": kind,
        "settings": learner.settings(),
        "robot": identity(robot),
    }
    _write(path, header, learner.state())


def join(path: Path, parts: Iterable[Path]) -> None:
    """Write one file with the runs of several, of the same kind of learner on the same robot.

    Raises InvalidFile.
    """
    header, states, by_run = None, [], []
    for part in parts:
        its_header, its_states = read(part)
        by_run += its_header["settings"].pop("by_run", [])
        if its_header != (header := header or its_header):
            raise InvalidFile(part, "it is of another learner or robot than the first")
        states += its_states
    if by_run:
        header["settings"]["by_run"] = by_run
    _write(path, header, states)


def identity(robot: "Robot") -> dict[str, Any]:
    """What tells a robot from others, in the types of JSON: what it does, not what it is called."""
    joints = np.arange(len(robot.joints)) + 1
    angles = np.sin(np.outer(np.arange(PROBES) + 1, joints))  # rad, a mixture of all joints
    numbers = {
        "kinematics": robot.arm.forward(angles),
        "home": robot.home,
        "workspace": robot.workspace.to_poses(1 - np.eye(6)),
    }
    names = {"joints": [*robot.joints], "tool": robot.arm.tool}
    return names | {name: value.ravel().tolist() for name, value in numbers.items()}


def differences(learned: Mapping[str, Any], here: Mapping[str, Any]) -> list[str]:
    """What differs between the identities of two robots."""
    found = [
        f"its {name} {'are' if name == 'joints' else 'is'} {learned[name]}, not {here[name]}"
        for name in ("joints", "tool")
        if learned[name] != here[name]
    ]
    if learned["joints"] != here["joints"]:
        return found
    for name in ("kinematics", "home", "workspace"):
        gap = np.abs(np.subtract(learned[name], here[name])).max()
        if not gap <= ALIKE:
            found.append(f"its {name} differs by up to {gap:.3g} m or rad")
    return found


def _write(path: Path, header: Mapping[str, Any], states: Sequence[State]) -> None:
    arrays = {}
    for run, state in enumerate(states):
        arrays |= flat(state, f"{run}/")
    with whole(path) as temporary:
        np.savez(temporary, header=json.dumps(header), **arrays)


def read(path: Path) -> tuple[dict[str, Any], list[State]]:
    """Header and runs of a file. Raises InvalidFile: not whole, or not of this format."""
    try:
        with open(path, "rb") as stream, np.load(stream) as file:
            arrays = {name: file[name][()] for name in file.files}
        header = json.loads(str(arrays.pop("header")))
        found = header["format"], header["version"]
    except (AttributeError, EOFError, KeyError, TypeError, ValueError, zipfile.BadZipFile):
        raise InvalidFile(path, "it is not whole, or not written by recalib.save") from None
    if any(array.dtype.kind == "f" and not np.isfinite(array).all() for array in arrays.values()):
        raise InvalidFile(path, "it holds numbers that are none")
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
