"""Names that do not exist: what may have been meant, and lists of names in a sentence."""

from collections.abc import Iterable
from difflib import SequenceMatcher

MOST, SOME = 10, 3  # names in a sentence: of all that are valid, or as examples


def nearest(word: str, valid: Iterable[str]) -> str | None:
    """The valid word that differs in the fewest letters, in a third of the word's at most.

    Letters are those that difflib would insert, delete or replace.
    """
    edits = {other: _edits(word, other) for other in valid}
    near = min(edits, key=edits.get, default=None)
    return near if near is not None and 3 * edits[near] <= len(word) else None


def _edits(word: str, other: str) -> int:
    changes = SequenceMatcher(None, word, other, autojunk=False).get_opcodes()
    return sum(max(b - a, d - c) for kind, a, b, c, d in changes if kind != "equal")


def instead(name: str, valid: Iterable[str]) -> str:
    """What to say in the place of a name: the nearest one, the valid ones, or some of many."""
    valid = list(valid)
    meant = f"did you mean {near}?" if (near := nearest(name, valid)) else ""
    if len(valid) > MOST:
        return meant or f"valid: one of {len(valid)}, such as {listed(valid[:SOME], 'and')}"
    return f"valid: {listed(valid, 'or') or 'none'}" + (meant and f"; {meant}")


def listed(words: Iterable[str], last: str) -> str:
    """Words with commas, and `last` before the last."""
    *rest, end = list(words) or [""]
    return f"{', '.join(rest)} {last} {end}" if rest else end
