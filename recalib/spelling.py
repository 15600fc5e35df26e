"""Unknown names: a suggestion, the valid names, and lists of names in a sentence."""

from collections.abc import Iterable
from difflib import get_close_matches
from itertools import takewhile

MOST, SOME = 10, 3  # names in a sentence: of all that are valid, or as examples
ALIKE = 0.75  # difflib's ratio: two letters of four exchanged, or one of two left out


def nearest(word: str, valid: Iterable[str]) -> str | None:
    """The valid word that is the most alike, if one is near; capitals do not count."""
    words, word = {other.casefold(): other for other in valid}, word.casefold()
    ending = _common_ending(words) if len(words) > 1 else ""
    if ending and word.endswith(ending):  # as .urdf: it does not make names alike
        words = {other.removesuffix(ending): name for other, name in words.items()}
        word = word.removesuffix(ending)
    found = get_close_matches(word, words, n=1, cutoff=ALIKE)
    return words[found[0]] if found else None


def _common_ending(words: Iterable[str]) -> str:
    letters = zip(*(word[::-1] for word in words), strict=False)
    return "".join(one[0] for one in takewhile(lambda one: len({*one}) == 1, letters))[::-1]


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
