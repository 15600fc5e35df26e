"""Mistakes in a configuration as sentences: the key, what stood there, what would be valid."""

from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches
from typing import Any, NamedTuple

from recalib.errors import RecalibError

MOST_SHOWN = 10  # mistakes, or names beside the one that was meant
MOST_LISTED = 20  # names where none was meant
LONGEST = 60  # characters of a value that are shown


class InvalidConfiguration(RecalibError):
    """A configuration with mistakes, a line for each of the first.

    Attributes:
        mistakes: all of the lines.
    """

    def __init__(self, mistakes: Sequence[str]):
        self.mistakes = list(mistakes)
        more = len(self.mistakes) - MOST_SHOWN
        rest = [f"... and {more} more"] if more > 0 else []
        super().__init__("\n".join([*self.mistakes[:MOST_SHOWN], *rest]))


KeyPath = tuple[str | int, ...]


class Mistake(NamedTuple):
    """What is wrong at the path of a key: the rest of a sentence that begins with the path."""

    path: KeyPath
    fault: str

    def __str__(self) -> str:
        return f"{dotted(self.path)}{self.fault}"


def dotted(path: KeyPath) -> str:
    """A path as people write it: scenarios.translation[0].shorten."""
    parts = (f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return "".join(parts).removeprefix(".")


def nearest(word: str, valid: Iterable[str]) -> str | None:
    """The valid word that may have been meant."""
    return next(iter(get_close_matches(word, list(valid), 1)), None)


def unlike(path: KeyPath, stood: Any, valid: str) -> Mistake:
    """A value that is none of the valid ones."""
    return Mistake(path, f" is {shown(stood)}; valid: {valid}")


def unknown(path: KeyPath, name: str, valid: Iterable[str]) -> Mistake:
    """A name that is not among the valid ones; the path may end with it."""
    valid = list(valid)
    near = nearest(name, valid)
    stood = ": unknown name" if path[-1] == name else f" is {shown(name)}"
    if near and len(valid) > MOST_SHOWN:
        return Mistake(path, f"{stood}; did you mean {near}?")
    first = (
        [*valid[:MOST_LISTED], f"another of {len(valid)}"] if len(valid) > MOST_LISTED else valid
    )
    hint = f"; did you mean {near}?" if near else ""
    return Mistake(path, f"{stood}; valid: {listed(first, 'or') or 'none'}{hint}")


def shown(value: Any) -> str:
    """A value as it would be written in YAML, without its length."""
    match value:
        case None:
            return "null"
        case bool():
            return str(value).lower()
        case str():
            return repr(value) if len(value) <= LONGEST else f"{value[:LONGEST]!r}..."
        case Mapping():
            return "a mapping" if value else "an empty mapping"
        case list() | tuple():
            scalars = not any(isinstance(each, list | tuple | Mapping) for each in value)
            text = f"[{', '.join(map(shown, value))}]"
            return text if value and scalars and len(text) <= LONGEST else _sized(value)
    return str(value)


def _sized(value: Sequence) -> str:
    return f"a list of {len(value)}" if value else "an empty list"


def listed(words: Iterable[str], last: str) -> str:
    """Words with commas, and `last` before the last."""
    *rest, end = list(words) or [""]
    return f"{', '.join(rest)} {last} {end}" if rest else end
