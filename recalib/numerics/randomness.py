"""Random numbers that depend on what they are for, and on nothing else."""

import zlib

import numpy as np


def generator(seed: int, *keys: str | int) -> np.random.Generator:
    """A generator for one purpose, such as generator(1996, "links", 0, "desired poses").

    In trainings learners are never among the keys: those that are compared see the same poses.
    A zero at the end of up to three keys counts as none: NumPy's [1, 2, 0] and [1, 2] are one seed.
    """
    words = [zlib.crc32(key.encode()) if isinstance(key, str) else key for key in keys]
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence([seed, *words])))
