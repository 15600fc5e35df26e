"""What the code says today, kept in files: a change that nobody meant is noticed.

A test hands `plain(values)` to `data_regression.check`. After a change that is meant, write the
files anew with `pytest --force-regen`, and look at the difference.
"""

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from typing import Any

import numpy as np
import pandas as pd
from pydantic import BaseModel

DIGITS = 6  # machines differ by rounding
MANY = 12  # values: of more, sums are kept


def plain(value: Any) -> Any:
    """A value in the types of YAML, with rounded numbers, and sums of the numbers of large arrays.

    The sums have uneven weights, so that values that change places are noticed.
    """
    match value:
        case BaseModel():
            return plain({name: getattr(value, name) for name in type(value).model_fields})
        case pd.DataFrame():
            return {str(name): plain(column.to_numpy()) for name, column in value.items()}
        case Mapping():
            return {str(name): plain(its) for name, its in value.items()}
        case Enum():
            return value.name
        case np.ndarray() if value.size > MANY and value.dtype.kind in "fiub":
            return {"shape": list(value.shape)} | _sums(value.astype(float).ravel())
        case np.ndarray():
            return plain(value.tolist())
        case list() | tuple() | set() | frozenset() as several:
            several = sorted(several) if isinstance(value, set | frozenset) else several
            return [plain(its) for its in several]
        case bool() | np.bool_():
            return bool(value)
        case float() | np.floating():
            return _rounded(float(value))
        case int() | np.integer():
            return int(value)
        case str() | None:
            return value
        case _ if callable(value):
            return "a function"
    if is_dataclass(value):
        return {its.name: plain(getattr(value, its.name)) for its in fields(value)}
    return repr(value)


def _sums(values: np.ndarray) -> dict[str, float]:
    known = values[np.isfinite(values)]
    weights = np.cos(np.arange(len(values)))[np.isfinite(values)]
    return {
        "mean": _rounded(known.mean()),
        "weighted": _rounded((weights * known).mean()),
        "least": _rounded(known.min()),
        "most": _rounded(known.max()),
        "unknown": len(values) - len(known),
    }


def _rounded(number: float) -> float:
    """So many digits, and none of what is rounding alone."""
    return float(f"{number:.{DIGITS}g}") if abs(number) > 1e-9 else 0.0
