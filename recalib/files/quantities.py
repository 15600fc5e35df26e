"""Quantities as text with a unit, such as '4 cm' and '-3 deg'."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

from recalib.errors import InvalidQuantity, InvalidSetting

_TEXT = re.compile(r"\s*([-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?)\s*([a-zA-Z/]+)\s*", re.ASCII)
_DIGITS = 15, 16, 17  # 15 digits hide rounding, 17 reproduce each float


@dataclass(frozen=True, eq=False)
class Quantity:
    """A kind of quantity, which reads and writes text.

    Attributes:
        name: the name with its article.
        units: the size of each unit in SI units; one unit has the size 1.
        farthest: the largest valid number of SI units in tables and descriptions of an arm.
    """

    name: str
    units: Mapping[str, float]
    farthest: float = math.inf

    def read(self, text: object) -> float:
        """The number of SI units in a text. Raises InvalidQuantity."""
        match = _TEXT.fullmatch(text) if isinstance(text, str) else None
        if match is None or match[2] not in self.units or math.isinf(float(match[1])):
            raise InvalidQuantity(text, self.units)
        return float(match[1]) * self.units[match[2]]

    def value_of(self, key: str, text: object) -> float:
        """The same, for a key or an option that the message names. Raises InvalidSetting."""
        try:
            return self.read(text)
        except InvalidQuantity:
            valid = f"{self.name} in {', '.join(self.units)}"
            raise InvalidSetting(key, text, valid) from None

    def write(self, value: float) -> str:
        """The shortest text that reads as exactly this finite number of SI units."""
        texts = (
            f"{float(f'{value / size:.{digits}g}')!r}".removesuffix(".0") + f" {unit}"
            for unit, size in self.units.items()
            for digits in _DIGITS
        )
        return min((text for text in texts if self.read(text) == value), key=len)


_DEGREE = math.pi / 180
NUMBER = Quantity("a number", {"": 1.0})
LENGTH = Quantity("a length", {"mm": 1e-3, "cm": 1e-2, "m": 1.0}, farthest=10.0)
ANGLE = Quantity("an angle", {"deg": _DEGREE, "rad": 1.0}, farthest=4 * math.pi)
COMPLIANCE = Quantity("a compliance", {"deg/Nm": _DEGREE, "rad/Nm": 1.0})
TIME = Quantity("a time", {"ms": 1e-3, "s": 1.0, "min": 60.0}, farthest=1e10)
