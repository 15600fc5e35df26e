"""Messages about mistakes in a configuration: the key, its value, and what was expected."""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

from recalib.errors import RecalibError
from recalib.spelling import instead

EXPECTED = "; expected: "
MOST_SHOWN = 10  # mistakes
LONGEST = 60  # characters of a value in a message


class InvalidConfiguration(RecalibError):
    """A configuration with mistakes; the message lists the first of `mistakes`, one a line."""

    def __init__(self, mistakes: Sequence[str]):
        self.mistakes = list(mistakes)
        more = len(self.mistakes) - MOST_SHOWN
        rest = [f"... and {more} more"] if more > 0 else []
        super().__init__("\n".join([*self.mistakes[:MOST_SHOWN], *rest]))


KeyPath = tuple[str | int, ...]


class Mistake(NamedTuple):
    """A mistake at the path of a key."""

    path: KeyPath  # the path of the key
    fault: str  # the rest of a sentence that begins with the path
    # other keys that contradict this one: the mistake is reported at the first of all these keys
    # that the user's sources set
    also: tuple[KeyPath, ...] = ()

    def __str__(self) -> str:
        return f"{dotted(self.path) or 'the study'}{self.fault}"


def dotted(path: KeyPath) -> str:
    """A path as text, such as scenarios.translation[0].shorten."""
    parts = (f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return "".join(parts).removeprefix(".")


def unlike(path: KeyPath, value: Any, valid: str, *also: KeyPath) -> Mistake:
    """The mistake of a value that is not valid."""
    return Mistake(path, f" is {shown(value)}{EXPECTED}{valid}", also)


def unknown(path: KeyPath, name: str, valid: Iterable[str]) -> Mistake:
    """The mistake of a name that is not among the valid names; the path may end with it."""
    fault = ": unknown name" if path[-1] == name else f" is {shown(name)}"
    return Mistake(path, f"{fault}; {instead(name, valid)}")


def shown(value: Any) -> str:
    """A value as in YAML; only the beginning of a long one."""
    match value:
        case None:
            return "null"
        case bool():
            return str(value).lower()
        case tuple():
            return shown(list(value))
    text = repr(value)
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}..."
