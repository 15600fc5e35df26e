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
    """Observations, and the names of their targets, sockets and instruments."""

    observations: Observations
    targets: tuple[str, ...] = TARGET
    sockets: tuple[str, ...] = ()
    instruments: tuple[str, ...] = ("the instrument",)
    known: Description = field(default_factory=Description)  # frames that the user gives
    # (s, 2) the numbers of instrument and target of each sight; None if there is one instrument
    sights: np.ndarray | None = None
    tables: tuple[Path, ...] = ()  # the files; if there are several, one for each sight
    nominal: np.ndarray | None = None  # (n, 3) m, positions according to the controller
    boards: tuple[str, ...] = ()  # names, if there are pictures
    doubts: Sequence[str] = ()  # warnings about lenses, each without its full stop
    # returns lens files by name, given corrections (o,) of `OPTICS`; None without pictures
    lens_files: Callable[[np.ndarray], Mapping[str, bytes]] | None = None

    def __len__(self) -> int:
        return len(self.observations)

    @property
    def target_names(self) -> list[str]:
        """Names of the targets for a sentence: `target left` if there are several."""
        plain = len(self.targets) == 1 or self.observations.optics is not None
        return [name if plain else f"target {name}" for name in self.targets]

    @property
    def sight_names(self) -> list[str]:
        """Names of the sights: each target, with its instrument if there are several."""
        if self.sights is None or len(self.instruments) == 1:
            return [*self.targets]
        pairs = self.sights.tolist()
        return [f"{self.targets[target]} by {self.instruments[one]}" for one, target in pairs]

    @property
    def scaled(self) -> list[str]:
        """Names of the lengths whose scale is checked: boards, distances or all positions."""
        if self.observations.sockets is not None:
            pairs = [(self.sockets[a], self.sockets[b]) for a, b, *_ in self.observations.distances]
            return [f"the distance between {one} and {other}" for one, other in pairs]
        return [*self.boards] or ["positions"]

    @property
    def rows_of_sights(self) -> list[str]:
        """For each sight, its range of rows, counted from 1, and its name."""
        ends = np.cumsum(np.bincount(self.observations.targets)).tolist()
        parts = zip([0, *ends[:-1]], ends, self.sight_names, strict=True)
        return [f"rows {before + 1} to {last}: {name}" for before, last, name in parts]


def data_set(rows: Measurements, known: Description, arm: Arm) -> DataSet:
    """The data set of measured rows. Raises InvalidFile if the description contradicts them."""
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
    """The distinct names among labels (n,), and the number (n,) of each label's name."""
    if labels is None:
        return missing, np.zeros(count, dtype=int)
    names, numbers = np.unique(labels, return_inverse=True)
    return tuple(names.tolist()), numbers
