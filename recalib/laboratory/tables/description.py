"""The description of a table (TOML): columns, frames and distances; see docs/own_arm.md."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from os import PathLike
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.errors import InvalidFile, InvalidSetting
from recalib.files.quantities import ANGLE, LENGTH, Quantity
from recalib.files.storage import read_file
from recalib.laboratory.tables.columns import FARTHEST
from recalib.spelling import listed

PARTS = "columns", "instrument", "target", "distance"
MOST = 16_000  # bytes: for a key of many parts, tomllib needs memory by the square of them
ORIGIN = {"position": ["0 m"] * 3, "roll_pitch_yaw": ["0 deg"] * 3}


@dataclass(frozen=True)
class Description:
    """What is special to one data set.

    Attributes:
        columns: by a heading of the table, what should have stood there, or "ignored".
        instrument: (4, 4) m in the arm's base frame; None where it is unknown.
        target: (4, 4) m in the tool link's frame; None where it is unknown.
        distances: m between the centres of two sockets, by their names in alphabetical order.
    """

    columns: Mapping[str, str] = field(default_factory=dict)
    instrument: np.ndarray | None = None
    target: np.ndarray | None = None
    distances: Mapping[tuple[str, str], float] = field(default_factory=dict)


def read_description(path: str | PathLike[str]) -> Description:
    """The description at `path`. Raises InvalidFile, which names the key."""
    try:
        parts = tomllib.loads(read_file(path, MOST).decode("utf-8"))
        for part in parts:
            if part not in PARTS:
                raise InvalidSetting("part", part, listed(PARTS, "or"))
        instrument, target = (_pose(part, parts) for part in ("instrument", "target"))
        return Description(
            _columns(parts.get("columns", {})),
            instrument,
            target,
            _distances(parts.get("distance", [])),
        )
    except InvalidSetting as error:
        raise InvalidFile(path, str(error)) from None
    except ValueError as error:  # not UTF-8, or not TOML
        raise InvalidFile(path, f"it is no TOML: {error}") from None
    except RecursionError:
        raise InvalidFile(path, "its parts are nested too deep") from None


def _columns(given: Any) -> dict[str, str]:
    if not isinstance(given, dict) or not all(isinstance(name, str) for name in given.values()):
        raise InvalidSetting("columns", given, 'lines such as joint_1 = "elbow_joint [deg]"')
    return given


def _pose(part: str, parts: Mapping[str, Any]) -> np.ndarray | None:
    if part not in parts:
        return None
    given = parts[part]
    if not isinstance(given, dict) or not given or given.keys() - ORIGIN.keys():
        raise InvalidSetting(part, given, f"{' and '.join(ORIGIN)}")
    numbers = ORIGIN | given
    pose = np.eye(4)
    pose[:3, 3] = _vector(f"{part}.position", numbers["position"], LENGTH)
    turns = _vector(f"{part}.roll_pitch_yaw", numbers["roll_pitch_yaw"], ANGLE)
    pose[:3, :3] = Rotation.from_euler("xyz", turns).as_matrix()
    return pose


def _vector(key: str, given: Any, kind: Quantity) -> list[float]:
    if not isinstance(given, list) or len(given) != 3:
        raise InvalidSetting(key, given, "a list of three quantities")
    return [_read(key, text, kind) for text in given]


def _distances(given: Any) -> dict[tuple[str, str], float]:
    if not isinstance(given, list):
        raise InvalidSetting("distance", given, "parts that begin with [[distance]]")
    distances: dict[tuple[str, str], float] = {}
    for pair, length in map(_distance, given):
        if pair in distances:
            found = f"{1e3 * distances[pair]:g} mm and {1e3 * length:g} mm"
            raise InvalidSetting(f"distance between {' and '.join(pair)}", found, "one length")
        distances[pair] = length
    return distances


def _distance(given: Any) -> tuple[tuple[str, str], float]:
    if not isinstance(given, dict) or given.keys() != {"sockets", "length"}:
        raise InvalidSetting("distance", given, "sockets and length")
    between = given["sockets"]
    pair = [str(name) for name in between] if isinstance(between, list) else []
    if len(pair) != 2 or pair[0] == pair[1]:
        raise InvalidSetting("distance.sockets", between, "the names of two sockets")
    one, other = sorted(pair)
    length = _read("distance.length", given["length"], LENGTH)
    if length <= 0:
        raise InvalidSetting("distance.length", given["length"], "more than zero")
    return (one, other), length


def _read(key: str, text: Any, kind: Quantity) -> float:
    number = kind.value_of(key, text)
    most, valid = FARTHEST[kind]
    if abs(number) > most:
        raise InvalidSetting(key, text, f"up to {valid}")
    return number
