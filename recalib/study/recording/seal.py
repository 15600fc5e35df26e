"""Recordings that know whether they are whole, and show what was measured.

Each carries a digest, since Rerun's own check misses some damage.
"""

import hashlib
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np
import pyarrow as pa
import rerun as rr
from rerun.blueprint import Blueprint
from rerun.chunk import Chunk, RrdReader
from rerun.error_utils import RerunWarning

from recalib.errors import RecalibError
from recalib.study.measured import ERRORS

SEAL = "/__properties/seal"
TIMELINES = {"moves", "time"}
ROW_IDS = "rerun.controls.RowId"  # new ones in every writing
PLACES = {ROW_IDS, "CoordinateFrame", "InstancePoses3D"}  # where a shape is; the rest says what
Columns = Mapping[str, Sequence]  # of measurements, as `History.columns` has them for one run


class BrokenRecording(RecalibError):
    """A recording that is not what it should be."""

    def __init__(self, path: Path, reason: str):
        self.path, self.reason = path, reason
        super().__init__(f"{path} is no valid recording: {reason}")


def write_sealed(
    path: Path, name: str, blueprint: Blueprint, fill: Callable[[rr.RecordingStream], None]
) -> None:
    """Write what `fill` logs, twice: its digest is known when it has been written once."""
    digest = None
    for _ in range(2):
        # without the properties that Rerun would add by itself: one is the time of writing
        rec = rr.RecordingStream("recalib", recording_id=name, send_properties=False)
        rec.save(path, default_blueprint=blueprint)
        fill(rec)
        if digest:
            rec.send_property("seal", rr.AnyValues(sha256=digest))
        rec.disconnect()
        digest = _digest(_chunks(path))


def check_recording(path: Path, measured: Mapping[str, Columns]) -> None:
    """Check that a recording is whole and that it shows what was measured.

    Args:
        measured: by learner.

    Raises BrokenRecording with the first reason found.
    """
    chunks = _chunks(path)
    seals = [
        chunk.to_record_batch().column("sha256")[0].as_py()[0]
        for chunk in chunks
        if chunk.entity_path == SEAL
    ]
    if seals != [_digest(chunks)]:
        raise BrokenRecording(path, "its content is not what was written")
    timelines = {name for chunk in chunks for name in chunk.timeline_names}
    if timelines != TIMELINES:
        raise BrokenRecording(
            path, f"its timelines are {sorted(timelines)} in place of {sorted(TIMELINES)}"
        )
    _check_meshes(path, chunks)
    batches = {
        chunk.entity_path: chunk.to_record_batch()
        for chunk in chunks
        if "moves" in chunk.timeline_names
    }
    for learner, columns in measured.items():
        shown = {}
        for quantity in ERRORS:
            entity = f"/errors/{quantity}/{learner}"
            if entity not in batches:
                raise BrokenRecording(path, f"no {entity}")
            shown["moves"] = batches[entity].column("moves").to_numpy()
            shown[quantity] = batches[entity].column("Scalars:scalars").flatten().to_numpy()
        check_errors(path, learner, shown, columns)


def check_errors(path: Path, learner: str, shown: Columns, measured: Columns) -> None:
    """Check that all that was measured of a learner is shown, and as it was.

    Raises BrokenRecording for the first measurement that differs.
    """
    rows = {moves: row for row, moves in enumerate(shown["moves"])}
    for row, moves in enumerate(measured["moves"]):
        where = f"{learner} after {moves} moves"
        if moves not in rows:
            raise BrokenRecording(path, f"{where} was measured, but is not shown")
        for quantity in ERRORS:
            ours = shown[quantity][rows[moves]]
            theirs = np.asarray(measured[quantity])[row]
            if not np.isclose(ours, theirs, rtol=1e-9, atol=1e-12):
                raise BrokenRecording(
                    path, f"{where}: {quantity} is {ours}, but was measured as {theirs}"
                )


def _chunks(path: Path) -> list[Chunk]:
    try:
        # a file that lacks its end is no more than a warning to Rerun
        with warnings.catch_warnings(action="error", category=RerunWarning):
            reader = RrdReader(path)
        if not (reader.recordings() and reader.blueprints()):
            raise BrokenRecording(path, "it lacks its data or its blueprint")
        return reader.store().stream().to_chunks()
    except (RerunWarning, RuntimeError, ValueError, OSError) as error:
        raise BrokenRecording(path, str(error)) from error


def _digest(chunks: list[Chunk]) -> str:
    """SHA-256 over every column with its entity and times.

    The order of chunks and the identities of rows do not matter.
    """
    columns = []
    for chunk in chunks:
        if chunk.entity_path == SEAL:
            continue
        batch = chunk.to_record_batch()
        times = [batch.column(name) for name in chunk.timeline_names]
        for name in set(batch.schema.names) - {ROW_IDS, *chunk.timeline_names}:
            columns_of_one = pa.record_batch(
                [*times, batch.column(name)], [*chunk.timeline_names, name]
            )
            columns.append(
                hashlib.sha256(chunk.entity_path.encode() + columns_of_one.serialize()).hexdigest()
            )
    return hashlib.sha256("".join(sorted(columns)).encode()).hexdigest()


def _check_meshes(path: Path, chunks: list[Chunk]) -> None:
    shapes: dict[str, set[str]] = {}
    for chunk in chunks:
        if "/visual_geometries/" in chunk.entity_path:
            names = (name.split(":")[0] for name in chunk.to_record_batch().schema.names)
            shapes.setdefault(chunk.entity_path, set()).update(names)
    bare = [entity for entity, names in shapes.items() if names <= PLACES]
    if bare or not shapes:
        raise BrokenRecording(path, f"no mesh for {', '.join(sorted(bare)) or 'any link'}")
