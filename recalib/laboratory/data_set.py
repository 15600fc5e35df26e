"""Measurements of an arm, with the names of instruments, targets and sockets."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from recalib.errors import InvalidFile
from recalib.identification.model.observations import Distance, Observations
from recalib.laboratory.tables.columns import NOMINAL, SOCKETS, TARGETS, TIMES
from recalib.laboratory.tables.description import Description
from recalib.laboratory.tables.measurements import Measurements
from recalib.nominal.kinematics import Arm

TARGET: tuple[str, ...] = ("the target",)


@dataclass(frozen=True)
class DataSet:
    """Observations, with names of targets, sockets and instruments by their numbers."""

    observations: Observations
    targets: tuple[str, ...] = TARGET
    sockets: tuple[str, ...] = ()
    instruments: tuple[str, ...] = ("the instrument",)
    known: Description = field(default_factory=Description)  # frames that the user gives
    # (s, 2) the numbers of instrument and target of each sight; None if there is one instrument
    sights: np.ndarray | None = None
    tables: tuple[Path, ...] = ()  # the files; several are each of another sight
    nominal: np.ndarray | None = None  # (n, 3) m, where the positions should have been
    boards: tuple[str, ...] = ()  # in pictures
    doubts: Sequence[str] = ()  # about lenses, in sentences without their full stops
    # the files of lenses by name, with corrections (o,) of `OPTICS`; None without pictures
    lens_files: Callable[[np.ndarray], Mapping[str, bytes]] | None = None

    def __len__(self) -> int:
        return len(self.observations)

    @property
    def target_names(self) -> list[str]:
        """The targets in a sentence: `target left` if a table names several."""
        plain = len(self.targets) == 1 or self.observations.optics is not None
        return [name if plain else f"target {name}" for name in self.targets]

    @property
    def sight_names(self) -> list[str]:
        """The targets, each with its instrument if there are several instruments."""
        if self.sights is None or len(self.instruments) == 1:
            return [*self.targets]
        pairs = self.sights.tolist()
        return [f"{self.targets[target]} by {self.instruments[one]}" for one, target in pairs]

    @property
    def scaled(self) -> list[str]:
        """Names of scales to check: boards, distances or all positions."""
        if self.observations.sockets is not None:
            pairs = [(self.sockets[a], self.sockets[b]) for a, b, *_ in self.observations.distances]
            return [f"the distance between {one} and {other}" for one, other in pairs]
        return [*self.boards] or ["positions"]

    @property
    def rows_of_sights(self) -> list[str]:
        """The rows of each sight, counted from 1, in words."""
        ends = np.cumsum(np.bincount(self.observations.targets)).tolist()
        parts = zip([0, *ends[:-1]], ends, self.sight_names, strict=True)
        return [f"rows {before + 1} to {last}: {name}" for before, last, name in parts]


def data_set(rows: Measurements, known: Description, arm: Arm) -> DataSet:
    """The measurements of an arm. Raises InvalidFile: the description does not go with them."""
    assert rows.joints is not None
    targets, target_numbers = _numbered(rows.columns.get(TARGETS.name), len(rows), TARGET)
    sockets, socket_numbers = _numbered(rows.columns.get(SOCKETS.name), len(rows), ())
    in_sockets = SOCKETS.name in rows.columns
    if known.distances and not in_sockets:
        found = "its description has a distance between sockets"
        raise InvalidFile(rows.path, f"{found}; the table has no column 'socket'")
    if in_sockets and known.instrument is not None:
        found = "its description has an instrument; a ball in sockets needs none"
        raise InvalidFile(rows.path, found)
    for name in (name for pair in known.distances for name in pair):
        if name not in sockets:
            found = f"its description names socket {name!r}"
            raise InvalidFile(rows.path, f"{found}; the table has {', '.join(sockets)}")
    observations = Observations(
        arm.coupling.joints(rows.joints),
        rows.measured,
        target_numbers,
        socket_numbers if in_sockets else None,
        [
            Distance(sockets.index(one), sockets.index(other), length)
            for (one, other), length in known.distances.items()
        ],
        rows.columns.get(TIMES.name),
    )
    return DataSet(
        observations,
        targets,
        sockets,
        known=known,
        tables=(rows.path,),
        nominal=rows.columns.get(NOMINAL.name),
    )


def _numbered(
    labels: np.ndarray | None, count: int, missing: tuple[str, ...]
) -> tuple[tuple[str, ...], np.ndarray]:
    """The names among labels (n,), and the number (n,) of each label's name."""
    if labels is None:
        return missing, np.zeros(count, dtype=int)
    names, numbers = np.unique(labels, return_inverse=True)
    return tuple(names.tolist()), numbers
