"""Random numbers that depend on their purpose and on nothing else."""

import zlib

import numpy as np


def generator(seed: int, *keys: str | int) -> np.random.Generator:
    """A generator for one purpose, such as generator(1996, "links", 0, "desired poses").

    The keys of a training never contain the learner, so that all learners see the same poses. With
    up to three keys, a trailing 0 has no effect: NumPy's seeds [1, 2, 0] and [1, 2] are the same.
    """
    words = [zlib.crc32(key.encode()) if isinstance(key, str) else key for key in keys]
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, *words])))
