"""Loops compiled by Numba, for functions that a training calls hundreds of times a second.

A compiled function and those that it calls belong in one file: Numba's cache notices changes of
that file alone. Cached functions take and return arrays, numbers and plain tuples of them: a cache
that refers to a class which a later version of the file lacks could not be read.

Compiled functions assign numbers one by one. An assignment to a slice takes two seconds longer to
compile, for an error message that no call here can raise.
"""

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from numba import njit

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


def compiled(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """The function, compiled at its first call, and cached in a file for later processes.

    If no folder is writable, it is not cached. A division by zero gives infinity, as in NumPy.
    """
    try:
        return njit(cache=True, error_model="numpy")(function)
    except RuntimeError:  # neither the file's folder nor the user's cache is writable
        return njit(error_model="numpy")(function)


def inner(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """The function, for calls from compiled functions: it is compiled and cached with them."""
    return njit(error_model="numpy")(function)
