"""Bounded quantities as types of fields: `shorten: Amount` reads '4 cm' and refuses '200 m'.

A type is a float in SI units with an annotation, which only Pydantic reads.
"""

import math
from dataclasses import dataclass
from numbers import Real
from typing import TYPE_CHECKING, Annotated, Any

from recalib.errors import InvalidQuantity, InvalidSetting
from recalib.files.quantities import ANGLE, COMPLIANCE, LENGTH, Quantity

if TYPE_CHECKING:
    from pydantic_core import CoreSchema


@dataclass(frozen=True)
class Bounded:
    """A quantity with bounds.

    Attributes:
        quantity: the kind of quantity; None for a bare number.
        low, high: the bounds, in SI units.
        bounds, example: the bounds and an example, in words.
        above: whether the lower bound itself is excluded.
        direction: whether the quantity is a direction and not a size.
    """

    quantity: Quantity | None
    low: float
    high: float
    bounds: str
    example: str
    above: bool = False
    direction: bool = False

    @property
    def expected(self) -> str:
        """The valid values, in words."""
        if self.quantity is None:
            return f"a number {self.bounds}, such as {self.example}"
        units = ", ".join(self.quantity.units)
        return f"{self.quantity.name} {self.bounds}, such as '{self.example}' ({units})"

    def holds(self, value: float) -> bool:
        """Whether a number in SI units is within the bounds."""
        return self.low <= value <= self.high and not (self.above and value == self.low)

    def check(self, name: str, value: float) -> None:
        """Raise InvalidSetting unless a value is a number in SI units within the bounds."""
        if isinstance(value, Real) and self.holds(float(value)):
            return
        if self.quantity is None:
            raise InvalidSetting(name, value, f"a number {self.bounds}")
        unit = next(unit for unit, size in self.quantity.units.items() if size == 1)
        raise InvalidSetting(name, value, f"{self.quantity.name} {self.bounds}, in {unit}")

    def _read(self, value: object) -> float:
        """The number in SI units that a value denotes; NaN if it is invalid."""
        if self.quantity is None:
            number = isinstance(value, int | float) and not isinstance(value, bool)
            return float(value) if number else math.nan  # type: ignore[arg-type]
        try:
            return self.quantity.read(value)
        except InvalidQuantity:
            return math.nan

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> "CoreSchema":
        from pydantic_core import PydanticCustomError, core_schema

        def read(value: object) -> float:
            number = self._read(value)
            if not self.holds(number):
                raise PydanticCustomError("expected", self.expected)
            return number

        write = self.quantity.write if self.quantity else float
        written = core_schema.plain_serializer_function_ser_schema(write, when_used="json")
        return core_schema.no_info_plain_validator_function(read, serialization=written)

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        message = {"patternErrorMessage": self.expected}
        if self.quantity is None:
            return {"type": "number", "minimum": self.low, "maximum": self.high} | message
        pattern = rf"^\s*[-+]?\d.*({'|'.join(self.quantity.units)})\s*$"
        return {"type": "string", "pattern": pattern} | message


Length = Annotated[float, Bounded(LENGTH, -100, 100, "from -100 to 100 m", "-4 cm")]
Size = Annotated[float, Bounded(LENGTH, 0, 100, "above 0 and up to 100 m", "4 cm", above=True)]
Amount = Annotated[float, Bounded(LENGTH, 0, 100, "from 0 to 100 m", "0.2 mm")]
Angle = Annotated[float, Bounded(ANGLE, -100, 100, "from -100 to 100 rad", "-3 deg")]
Turn = Annotated[float, Bounded(ANGLE, 0, 3.15, "from 0 to 180 deg", "0.02 deg")]
SignedTurn = Annotated[float, Bounded(ANGLE, -3.15, 3.15, "from -180 to 180 deg", "-3 deg")]
Direction = Annotated[
    float, Bounded(ANGLE, -6.3, 6.3, "from -360 to 360 deg", "90 deg", direction=True)
]
# standard deviations: with larger ones, an arm or an instrument would be useless
Noise = Annotated[float, Bounded(LENGTH, 0, 0.1, "from 0 to 10 cm", "0.2 mm")]
NoiseOfTurn = Annotated[float, Bounded(ANGLE, 0, 0.175, "from 0 to 10 deg", "0.02 deg")]
Compliance = Annotated[float, Bounded(COMPLIANCE, 0, 1, "from 0 to 1 rad/Nm", "0.0002 rad/Nm")]
Share = Annotated[float, Bounded(None, 0, 1, "from 0 to 1", "0.1")]
# of a workspace: a smaller one would be out of proportion to any damage
Side = Annotated[float, Bounded(LENGTH, 1e-3, 100, "from 1 mm to 100 m", "40 cm")]
Range = Annotated[float, Bounded(ANGLE, 1e-3, 3.1416, "from 0.1 to 180 deg", "40 deg")]
