"""Names that do not exist: what may have been meant, and lists of names in a sentence."""

from collections.abc import Iterable
from functools import cache

MOST, SOME = 10, 3  # names in a sentence: of all that are valid, or as examples


def nearest(word: str, valid: Iterable[str]) -> str | None:
    """The valid word that is the fewest edits away, if those are at most a third of the word.

    Capitals do not count.
    """
    alike = [other for other in valid if 3 * abs(len(word) - len(other)) <= len(word)]
    edits = {other: _edits(word.casefold(), other.casefold()) for other in alike}
    best = min(edits, key=lambda other: edits[other], default=None)
    return best if best is not None and 3 * edits[best] <= len(word) else None


def _edits(word: str, other: str) -> int:
    """How many letters to insert, delete, replace or swap: Damerau and Levenshtein's distance."""

    @cache
    def between(i: int, j: int) -> int:
        if not i or not j:
            return i + j
        ways = [between(i - 1, j) + 1, between(i, j - 1) + 1]
        ways.append(between(i - 1, j - 1) + (word[i - 1] != other[j - 1]))
        if min(i, j) > 1 and word[i - 2 : i] == other[j - 1] + other[j - 2]:
            ways.append(between(i - 2, j - 2) + 1)
        return min(ways)

    return between(len(word), len(other))


def instead(name: str, valid: Iterable[str]) -> str:
    """What to say in the place of a name: the nearest one, the valid ones, or some of many."""
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
