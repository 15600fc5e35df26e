"""What compiles the loops of robots and learners."""

import numpy as np
import pytest
from numba.core import caching

from recalib.compiled import compiled


def over(one, other):
    return one / other


def test_a_division_by_zero_is_infinite_as_in_numpy():
    assert compiled(over)(1.0, 0.0) == np.inf


def test_where_nothing_can_be_kept_it_is_compiled_all_the_same(monkeypatch):
    monkeypatch.setattr(caching.CacheImpl, "_locator_classes", [])
    with pytest.raises(RuntimeError, match="no locator available"):
        caching.FunctionCache(over)
    assert compiled(over)(1.0, 4.0) == 0.25
