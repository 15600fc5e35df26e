"""What is wrong with a configuration, in sentences."""

from collections.abc import Iterable
from difflib import get_close_matches


def nearest(word: str, valid: Iterable[str]) -> str | None:
    """The valid word that may have been meant."""
    return next(iter(get_close_matches(word, list(valid), 1)), None)
