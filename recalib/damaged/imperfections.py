"""By what a real arm may differ from its model: damages, and what disturbs moves and measurements.

The fields of a class are the words of a configuration: {link: forearm_link, shorten: 4 cm}.
"""

from collections.abc import Iterator
from dataclasses import dataclass, fields
from functools import cache
from typing import Any, ClassVar, get_type_hints

from recalib.files.bounded import Bounded


@dataclass(frozen=True)
class Imperfection:
    """Base of frozen dataclasses; amounts are SI units within the bounds of their types.

    Attributes:
        kinds: every subclass that names its words, by each of them.

    Raises InvalidSetting for an amount beyond its bounds.
    """

    kinds: ClassVar[dict[str, type["Imperfection"]]] = {}

    def __init_subclass__(cls, words: tuple[str, ...] = ()) -> None:
        """Args: words: fields by which a reader knows the kind; no other kind has them."""
        super().__init_subclass__()
        cls.kinds.update(dict.fromkeys(words, cls))

    def __post_init__(self) -> None:
        for name, bounded in amounts(type(self)).items():
            for amount in numbers(getattr(self, name)):
                bounded.check(f"{type(self).__name__}.{name}", amount)


@cache
def amounts(kind: type[Imperfection]) -> dict[str, Bounded]:
    """The fields that hold a bounded quantity, or three of them."""
    hints = get_type_hints(kind, include_extras=True)
    return {
        field.name: note
        for field in fields(kind)
        for note in _notes(hints[field.name])
        if isinstance(note, Bounded)
    }


def numbers(value: float | tuple[float, ...]) -> tuple[float, ...]:
    """One number or three, as a tuple."""
    return value if isinstance(value, tuple) else (value,)


def _notes(hint: Any) -> Iterator[Any]:
    """What `Annotated` notes of a type, or of the parts of a tuple."""
    yield from getattr(hint, "__metadata__", ())
    for part in getattr(hint, "__args__", ())[:1]:
        yield from getattr(part, "__metadata__", ())
