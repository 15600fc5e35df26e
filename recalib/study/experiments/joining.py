"""Chunks put together: tables, and what was learned."""

from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from recalib.learners.learned import join


def put_together(chunks: list[Path]) -> pa.Table:
    """The tables in these files as one."""
    return pa.concat_tables(map(pq.read_table, chunks))


def training(histories: list[Path], parts: list[Path], learned: Path) -> pa.Table:
    """The history of a training, from those of its chunks; what these learned is joined, too."""
    join(learned, parts)
    return put_together(histories)
