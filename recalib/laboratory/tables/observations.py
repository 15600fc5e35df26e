"""The rows of a table as observations of an arm, with the names of targets and sockets."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from recalib.errors import InvalidFile
from recalib.identification.model.observations import Distance, Observations
from recalib.laboratory.tables.description import Description
from recalib.laboratory.tables.measurements import Measurements


def observations_of(
    rows: Measurements, given: Description, table: Path
) -> tuple[Observations, tuple[str, ...], tuple[str, ...]]:
    """What was measured, with the names of targets and of sockets."""
    targets, numbers = _numbered(rows.targets, len(rows))
    observations = Observations(rows.joints, rows.measured, numbers, times=rows.times)
    if rows.sockets is None:
        if given.distances:
            raise InvalidFile(
                table,
                "its description has a distance between sockets; the table has no column 'socket'",
            )
        return observations, targets, ()
    if given.instrument is not None:
        raise InvalidFile(table, "its description has an instrument; a ball in sockets needs none")
    sockets, where = _numbered(rows.sockets, len(rows))
    for pair in given.distances:
        for socket in pair:
            if socket not in sockets:
                raise InvalidFile(
                    table,
                    f"its description names socket {socket!r}; the table has {', '.join(sockets)}",
                )
    distances = [
        Distance(sockets.index(one), sockets.index(other), length)
        for (one, other), length in given.distances.items()
    ]
    return replace(observations, sockets=where, distances=distances), targets, sockets


def _numbered(labels: np.ndarray | None, count: int) -> tuple[tuple[str, ...], np.ndarray]:
    if labels is None:
        return ("the target",), np.zeros(count, dtype=int)
    names, numbers = np.unique(labels, return_inverse=True)
    return tuple(names.tolist()), numbers
