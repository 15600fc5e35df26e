"""What a recording holds, in values that can be compared."""

from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
from rerun.chunk import RrdReader


def logged(path: Path) -> dict[str, Any]:
    """The times and the values of each component of each entity.

    Of a mesh it is kept how large it is, of texts each one, and how many there are.
    """
    found: dict[str, Any] = {}
    for chunk in RrdReader(path).store().stream().to_chunks():
        batch = chunk.to_record_batch()
        for name in batch.schema.names:
            if "RowId" not in name:
                values = _values(batch.column(name))
                if "blob" in name:
                    values = len(values)
                elif values.dtype == object:
                    values = [len(values), *dict.fromkeys(values.tolist())]
                found.setdefault(f"{chunk.entity_path} {name}", []).append(values)
    return {key: found[key] for key in sorted(found)}


def _values(column: pa.Array) -> np.ndarray:
    """All that stands in a column, however nested."""
    while pa.types.is_nested(column.type):
        if pa.types.is_struct(column.type):
            return np.concatenate([_values(part) for part in column.flatten()])
        column = column.flatten()
    return column.to_numpy(zero_copy_only=False)
