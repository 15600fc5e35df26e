"""The description of a table (TOML): columns, frames and distances; see docs/own_arm.md."""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.errors import InvalidFile, InvalidSetting
from recalib.files.outputs import AnyPath
from recalib.files.quantities import ANGLE, LENGTH, Quantity
from recalib.files.storage import read_toml
from recalib.identification.model.frames import EXACT, LINK, Frames
from recalib.spelling import listed

PARTS = "columns", "instrument", "target", "distance", "wear"
PLUS_MINUS = re.compile(r"\s*(?:\+/?-|±)\s*")


@dataclass(frozen=True)
class Description:
    """Frames, distances and columns that a table of measurements cannot express.

    Attributes:
        columns: maps a heading of the table to the heading that it should have, or "ignored".
        instrument: (4, 4) m in the arm's base frame; None if unknown.
        target: (4, 4) m in the tool link's frame; None if unknown.
        instrument_deviations, target_deviations: (6,) m and rad, standard deviations along and
            about the axes of those frames; None if the pose is unknown or exact.
        encoders: rad, standard deviation of an encoder's zero; 0 if it is not stated.
        links: m and rad, standard deviations of a link; None if they are not stated.
        distances: m between the centres of two sockets, by their names in alphabetical order.
    """

    columns: Mapping[str, str] = field(default_factory=dict)
    instrument: np.ndarray | None = None
    target: np.ndarray | None = None
    distances: Mapping[tuple[str, str], float] = field(default_factory=dict)
    instrument_deviations: np.ndarray | None = None
    target_deviations: np.ndarray | None = None
    encoders: float = 0.0
    links: tuple[float, float] | None = None

    def stated_in(self, frames: Frames) -> Frames:
        """The same frames, with the stated deviations of frames, encoders and links as priors."""
        frames = frames.with_priors(self.instrument_deviations, self.target_deviations)
        frames = replace(frames, offset_deviation=self.encoders)
        if self.links is None:
            return frames
        ends = self.links if frames.target_deviations == LINK else frames.target_deviations
        return replace(frames, link_deviations=self.links, target_deviations=ends)


def read_description(path: AnyPath) -> Description:
    """The description at `path`. Raises InvalidFile, with the key at fault."""
    parts = read_toml(path)
    try:
        for part in parts:
            if part not in PARTS:
                raise InvalidSetting("part", part, listed(PARTS, "or"))
        columns = parts.get("columns", {})
        if not isinstance(columns, dict) or not all(isinstance(to, str) for to in columns.values()):
            raise InvalidSetting("columns", columns, 'lines such as joint_1 = "elbow_joint [deg]"')
        return Description(
            columns,
            distances=distances_of(_distances(parts.get("distance", []))),
            **_pose("instrument", parts),
            **_pose("target", parts),
            **_wear(parts.get("wear", {})),
        )
    except InvalidSetting as error:
        raise InvalidFile(path, str(error)) from None


def _pose(part: str, parts: Mapping[str, Any]) -> dict[str, Any]:
    """The pose of an instrument or target and its deviations, if they are stated."""
    if part not in parts:
        return {}
    given = parts[part]
    if not isinstance(given, dict) or not given or given.keys() - {"position", "roll_pitch_yaw"}:
        raise InvalidSetting(part, given, "position and roll_pitch_yaw")
    vectors = []
    for name, kind in (("position", LENGTH), ("roll_pitch_yaw", ANGLE)):
        key, numbers = f"{part}.{name}", given.get(name, [kind.write(0.0)] * 3)
        if not isinstance(numbers, list) or len(numbers) != 3:
            raise InvalidSetting(key, numbers, 'a list of three quantities such as "3 mm +- 1 mm"')
        vectors.append(np.array([within(key, number, kind) for number in numbers]).T)
    (place, along), (turns, about) = vectors
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = Rotation.from_euler("xyz", turns).as_matrix(), place
    deviations = np.concatenate([along, about])
    stated = {f"{part}_deviations": np.maximum(deviations, EXACT)} if deviations.any() else {}
    return {part: pose} | stated


def within(key: str, given: Any, kind: Quantity, default: float = 0.0) -> tuple[float, float]:
    """Read a value and its deviation, as in "3 mm +- 1 mm". Raises InvalidSetting."""
    value, *deviation = PLUS_MINUS.split(given, 1) if isinstance(given, str) else [given]
    number = _read(key, value, kind)
    if not deviation:
        return number, default
    return number, _read(f"the deviation of {key}", deviation[0], kind, positive=True)


def _wear(given: Any) -> dict[str, Any]:
    """The standard deviations of encoders and links, if they are stated."""
    if not isinstance(given, dict) or given.keys() - {"encoders", "links"}:
        raise InvalidSetting("wear", given, 'encoders = "1 deg" and links = ["2 mm", "0.1 deg"]')
    encoders, links = given.get("encoders"), given.get("links")
    if links is not None and (not isinstance(links, list) or len(links) != 2):
        raise InvalidSetting("wear.links", links, 'a length and an angle: ["2 mm", "0.1 deg"]')
    stated: dict[str, Any] = {}
    if links is not None:
        pairs = zip(links, (LENGTH, ANGLE), strict=True)
        stated["links"] = tuple(_read("wear.links", text, kind, True) for text, kind in pairs)
    if encoders is not None:
        stated["encoders"] = _read("wear.encoders", encoders, ANGLE, True)
    return stated


def _distances(given: Any) -> Iterator[tuple[Any, float]]:
    """Two sockets and their distance [m], for each part of a description."""
    if not isinstance(given, list):
        raise InvalidSetting("distance", given, "parts that begin with [[distance]]")
    for part in given:
        if not isinstance(part, dict) or part.keys() != {"sockets", "length"}:
            raise InvalidSetting("distance", part, "sockets and length")
        yield part["sockets"], _read("distance.length", part["length"], LENGTH, True)


def distances_of(given: Iterable[tuple[Any, float]]) -> dict[tuple[str, str], float]:
    """Distances [m] of pairs of sockets, by their sorted names. Raises InvalidSetting."""
    distances: dict[tuple[str, str], float] = {}
    for between, length in given:
        names = sorted(map(str, between)) if isinstance(between, (list, tuple)) else []
        if len(names) != 2 or names[0] == names[1]:
            raise InvalidSetting("distance.sockets", between, "the names of two sockets")
        pair = names[0], names[1]
        if pair in distances:
            found = f"{1e3 * distances[pair]:g} mm and {1e3 * length:g} mm"
            raise InvalidSetting(f"distance between {' and '.join(pair)}", found, "one length")
        distances[pair] = length
    return distances


def _read(key: str, text: Any, kind: Quantity, positive: bool = False) -> float:
    number = kind.value_of(key, text)
    if abs(number) > kind.farthest:
        raise InvalidSetting(key, text, f"up to {kind.write(kind.farthest)}")
    if positive and number <= 0:
        raise InvalidSetting(key, text, "more than zero")
    return number
