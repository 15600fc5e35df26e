"""Suggestions for misspelt names, and lists of names in a sentence."""

from collections.abc import Iterable
from difflib import get_close_matches
from itertools import takewhile

MOST, SOME = 10, 3  # the most names to list in full; the number of examples from a longer list
ALIKE = 0.75  # difflib's ratio, which tolerates e.g. two swapped letters in a word of four


def nearest(word: str, valid: Iterable[str]) -> str | None:
    """The valid word most similar to `word`, regardless of case; None if none is similar."""
    words, word = {other.casefold(): other for other in valid}, word.casefold()
    ending = _common_ending(words) if len(words) > 1 else ""
    if ending and word.endswith(ending):  # a shared suffix such as .urdf is no similarity
        words = {other.removesuffix(ending): name for other, name in words.items()}
        word = word.removesuffix(ending)
    found = get_close_matches(word, words, n=1, cutoff=ALIKE)
    return words[found[0]] if found else None


def _common_ending(words: Iterable[str]) -> str:
    letters = zip(*(word[::-1] for word in words), strict=False)
    return "".join(one[0] for one in takewhile(lambda one: len({*one}) == 1, letters))[::-1]


def instead(name: str, valid: Iterable[str]) -> str:
    """Advice in place of an unknown name: a similar name, and the valid names or examples."""
    valid = list(valid)
    meant = f"did you mean {other}?" if (other := nearest(name, valid)) else ""
    if len(valid) > MOST:
        return meant or f"expected: one of {len(valid)}, such as {listed(valid[:SOME], 'and')}"
    return f"expected: {listed(valid, 'or') or 'none'}" + (meant and f"; {meant}")


def counted(number: int, noun: str) -> str:
    """A number with its noun in the singular or plural: 1 row, 2 rows."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def listed(words: Iterable[str], last: str) -> str:
    """The words as a list with commas, and the conjunction `last` before the last word."""
    *rest, end = list(words) or [""]
    return f"{', '.join(rest)} {last} {end}" if rest else end
