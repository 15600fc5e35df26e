"""Loops compiled by Numba: of robots and learners, what a training does hundreds of times a second.

A function that calls another compiled one belongs into the same file: of what is kept, Numba
notices changes of that file alone.

Numbers are written one by one: whatever assigns to a slice, Numba compiles two seconds longer, for
the words of an error that no call here can raise.
"""

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from numba import njit

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


def compiled(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """The function, compiled when it is first called, and kept in a file for the next process.

    Where no folder can be written to it is not kept. A division by zero gives infinity, as in
    NumPy.
    """
    try:
        return njit(cache=True, error_model="numpy")(function)
    except RuntimeError:  # neither beside the file nor in the user's cache
        return njit(error_model="numpy")(function)
