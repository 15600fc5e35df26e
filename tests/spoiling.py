"""Archives that somebody changed by hand: other members, shapes, types and numbers."""

import json
from pathlib import Path

import numpy as np
from hypothesis import strategies as st

from recalib.files import write_archive

CHANGES = {
    "gone": lambda array: None,
    "shorter": lambda array: array[..., :-1] if array.ndim else array,
    "empty": lambda array: array[:0] if array.ndim else array,
    "flat": lambda array: array.ravel(),
    "a scalar": lambda array: array.ravel()[:1].squeeze(),
    "one axis more": lambda array: array[None],
    "doubled": lambda array: np.concatenate([array, array]) if array.ndim else array,
    "zeros": np.zeros_like,
    "negative": lambda array: -array.astype(float) if array.dtype.kind in "fiub" else array,
    "huge": lambda array: np.full(array.shape, 1e300),
    "integers": lambda array: np.ones(array.shape, dtype=int),
    "words": lambda array: np.full(array.shape, "word"),
    "complex": lambda array: np.full(array.shape, 1j),
    "truths": lambda array: np.ones(array.shape, dtype=bool),
    "a JSON of it": lambda array: np.array('{"a": [1, null]}'),
}


def spoil(draw: st.DrawFn, path: Path) -> None:
    """Change a member or two of an archive, or a key of its header; perhaps seal it anew."""
    with np.load(path) as file:
        arrays = dict(file)
    header = json.loads(str(arrays.pop("header")))
    for name in draw(st.lists(st.sampled_from([*arrays]), max_size=2, unique=True)):
        changed = CHANGES[draw(st.sampled_from([*CHANGES]))](arrays.pop(name))
        if changed is not None:
            arrays[draw(st.sampled_from([name, name, name, f"{name}/a", "other"]))] = changed
    for key in draw(st.lists(st.sampled_from([*header]), max_size=1)):
        value = draw(st.sampled_from([None, -1, "word", [], {}, [{}], {"a": 1}, 1e300]))
        header |= {key: value}
    if draw(st.booleans()):
        header.pop("sha256", None)
        write_archive(path, header, arrays)
    else:
        np.savez(path, header=json.dumps(header), **arrays)
