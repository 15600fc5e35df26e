"""Damages as a configuration describes them: {link: forearm_link, shorten: 4 cm}.

The fields of a class name their words. Reading and writing of descriptions follow from these.
"""

import dataclasses
import math
from dataclasses import dataclass
from numbers import Real
from typing import Any, ClassVar

from recalib.errors import InvalidSetting
from recalib.files.quantities import ANGLE, LENGTH, Quantity

MOST = {ANGLE: math.pi, LENGTH: LENGTH.farthest}  # rad, m, of what can happen to an arm


@dataclass(frozen=True)
class Word:
    """What people write for a field.

    Attributes:
        key: the word.
        meaning: of what stands behind it.
        quantity: in SI units; None: a name, or a bare number.
        signed: whether it may be negative.
        grows: whether it is larger where the damage is.
    """

    key: str
    meaning: str
    quantity: Quantity | None
    signed: bool
    grows: bool


def said(
    key: str,
    meaning: str,
    quantity: Quantity | None = None,
    *,
    signed: bool = False,
    grows: bool = True,
    default: Any = dataclasses.MISSING,
) -> Any:
    """A field of a `Described` dataclass, with its word."""
    word = Word(key, meaning, quantity, signed, grows and quantity is not None)
    return dataclasses.field(default=default, metadata={"word": word})


@dataclass(frozen=True)
class Described:
    """Base of frozen dataclasses whose fields are `said`: words and SI units.

    Attributes:
        under: the word under which the others stand, as `noise` in {noise: {position: 1 mm}}.

    Raises InvalidSetting for an amount that is not finite, negative where it must not be, or larger
    than such an amount can be.
    """

    under: ClassVar[str | None] = None

    def __post_init__(self) -> None:
        for name, word in words(type(self)).items():
            value = getattr(self, name)
            if isinstance(value, str) and word.quantity is None:
                continue
            for amount in value if isinstance(value, tuple | list) else (value,):
                finite = isinstance(amount, Real) and math.isfinite(amount)
                if not finite or (amount < 0 and not word.signed):
                    valid = "finite" if word.signed else "a finite number from 0 on"
                    raise InvalidSetting(f"{type(self).__name__}.{name}", amount, valid)
                most = MOST.get(word.quantity) if word.quantity and word.grows else None
                if most is not None and abs(amount) > most:
                    valid = f"at most {most:.4g} (m, rad); is its unit right?"
                    raise InvalidSetting(f"{type(self).__name__}.{name}", amount, valid)


def words(kind: type[Described]) -> dict[str, Word]:
    """The word of each field."""
    return {field.name: field.metadata["word"] for field in dataclasses.fields(kind)}
