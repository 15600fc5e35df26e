"""Unknown names: a suggestion, the valid names, and lists of names in a sentence."""

from collections.abc import Iterable
from difflib import get_close_matches

MOST, SOME = 10, 3  # names in a sentence: of all that are valid, or as examples
ALIKE = 0.75  # difflib's ratio: two letters of four exchanged, or one of two left out


def nearest(word: str, valid: Iterable[str]) -> str | None:
    """The valid word that is the most alike, if one is near; capitals do not count."""
    words = {other.casefold(): other for other in valid}
    found = get_close_matches(word.casefold(), words, n=1, cutoff=ALIKE)
    return words[found[0]] if found else None


def instead(name: str, valid: Iterable[str]) -> str:
    """What to use in the place of a name: the nearest one, the valid ones, or some of many."""
    valid = list(valid)
    meant = f"did you mean {other}?" if (other := nearest(name, valid)) else ""
    if len(valid) > MOST:
        return meant or f"expected: one of {len(valid)}, such as {listed(valid[:SOME], 'and')}"
    return f"expected: {listed(valid, 'or') or 'none'}" + (meant and f"; {meant}")


def counted(number: int, noun: str) -> str:
    """A number and what it counts: 1 row, 2 rows."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def listed(words: Iterable[str], last: str) -> str:
    """Words with commas, and `last` before the last."""
    *rest, end = list(words) or [""]
    return f"{', '.join(rest)} {last} {end}" if rest else end
