"""Bounded quantities as types of fields: `shorten: Length` reads '4 cm', and refuses '200 m'.

A type is a float of SI units with a note. Pydantic reads the note, which needs no pydantic itself.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

from recalib.errors import InvalidQuantity, InvalidSetting
from recalib.files.quantities import ANGLE, COMPLIANCE, LENGTH, Quantity

if TYPE_CHECKING:
    from pydantic_core import CoreSchema


@dataclass(frozen=True)
class Bounded:
    """A quantity with bounds, in SI units.

    Attributes:
        quantity: its kind.
        low, high: the bounds.
        above: whether the lower bound itself is excluded.
        bounds, example: in words, for people.
    """

    quantity: Quantity
    low: float
    high: float
    bounds: str
    example: str
    above: bool = False

    @property
    def expected(self) -> str:
        """What is valid, for people."""
        units = ", ".join(self.quantity.units)
        return f"{self.quantity.name} {self.bounds}, such as '{self.example}' ({units})"

    def holds(self, value: float) -> bool:
        """Whether a number of SI units lies within the bounds."""
        return self.low <= value <= self.high and not (self.above and value == self.low)

    def check(self, name: str, value: float) -> None:
        """Raises InvalidSetting for a number of SI units beyond the bounds."""
        if not math.isfinite(value) or not self.holds(value):
            unit = next(unit for unit, size in self.quantity.units.items() if size == 1)
            raise InvalidSetting(name, value, f"{self.quantity.name} {self.bounds}, in {unit}")

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> "CoreSchema":
        from pydantic_core import PydanticCustomError, core_schema

        def read(text: object) -> float:
            try:
                value = self.quantity.read(text)
            except InvalidQuantity:
                value = math.nan
            if not self.holds(value):
                raise PydanticCustomError("expected", self.expected)  # type: ignore[arg-type]
            return value

        written = core_schema.plain_serializer_function_ser_schema(
            self.quantity.write, when_used="json"
        )
        return core_schema.no_info_plain_validator_function(read, serialization=written)

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, str]:
        pattern = rf"^\s*[-+]?\d.*({'|'.join(self.quantity.units)})\s*$"
        return {"type": "string", "pattern": pattern, "patternErrorMessage": self.expected}


Length = Annotated[float, Bounded(LENGTH, -100, 100, "from -100 to 100 m", "-4 cm")]
Size = Annotated[float, Bounded(LENGTH, 0, 100, "above 0 and up to 100 m", "4 cm", above=True)]
Amount = Annotated[float, Bounded(LENGTH, 0, 100, "from 0 to 100 m", "0.2 mm")]
Angle = Annotated[float, Bounded(ANGLE, -100, 100, "from -100 to 100 rad", "-3 deg")]
Turn = Annotated[float, Bounded(ANGLE, 0, 3.15, "from 0 to 180 deg", "0.02 deg")]
SignedTurn = Annotated[float, Bounded(ANGLE, -3.15, 3.15, "from -180 to 180 deg", "-3 deg")]
# of what is random: in more no arm and no instrument would be of use
Noise = Annotated[float, Bounded(LENGTH, 0, 0.1, "from 0 to 10 cm", "0.2 mm")]
NoiseOfTurn = Annotated[float, Bounded(ANGLE, 0, 0.175, "from 0 to 10 deg", "0.02 deg")]
Compliance = Annotated[float, Bounded(COMPLIANCE, 0, 1, "from 0 to 1 rad/Nm", "0.0002 rad/Nm")]
# of a workspace: in units of a smaller one, damages would be out of all proportion
Side = Annotated[float, Bounded(LENGTH, 1e-3, 100, "from 1 mm to 100 m", "40 cm")]
Range = Annotated[float, Bounded(ANGLE, 1e-3, 3.1416, "from 0.1 to 180 deg", "40 deg")]
