"""Loops compiled by Numba: what a training calls hundreds of times a second.

A compiled function and those that it calls belong in one file: Numba's cache notices changes of
that file alone. What is cached takes and returns arrays, numbers and plain tuples of them: a cache
with a class that a later version of the file lacks could not be read.

Numbers are assigned one by one: an assignment to a slice takes two seconds longer to compile, for
an error message that no call here can raise.
"""

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from numba import njit

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


def compiled(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """The function, compiled when it is first called, and kept in a file for the next process.

    If no folder can be written to it is not kept. A division by zero gives infinity, as in
    NumPy.
    """
    try:
        return njit(cache=True, error_model="numpy")(function)
    except RuntimeError:  # neither beside the file nor in the user's cache
        return njit(error_model="numpy")(function)


def inner(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """The function, for compiled ones to call: it is compiled, and cached, as a part of them."""
    return njit(error_model="numpy")(function)
