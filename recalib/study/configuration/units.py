"""Values of the configuration as types: each knows its unit and its range, and reads what it writes.

Quantities are text such as `4 cm` and become SI numbers. Counts are whole numbers, no text, no 4.0.
"""

from collections.abc import Callable
from typing import Annotated, Any

from annotated_types import Ge, Gt, Le, Lt
from pydantic import BeforeValidator, Field, PlainSerializer, WithJsonSchema
from pydantic_core import PydanticCustomError

from recalib import quantities
from recalib.errors import InvalidQuantity

MOST = 1_000_000  # of whatever is counted: more would run for days
NAME = r"^[A-Za-z]\w*$"  # of a robot, a scenario, a learner: it becomes part of paths


def _quantity(
    kind: str, parse: Callable[[str], float], units: dict[str, float], example: str, *limits: Any
) -> Any:
    """The type of text such as `4 cm` that becomes a number of SI units within the limits."""
    si = next(unit for unit, size in units.items() if size == 1.0)

    def read(text: object) -> float:
        try:
            return parse(text)
        except InvalidQuantity:
            valid = f"{kind} as a number and one of {', '.join(units)}, such as '{example}'"
            raise PydanticCustomError("quantity", "{valid}", {"valid": valid}) from None

    schema = {"type": "string", "pattern": rf"^[-+]?\d.* ?({'|'.join(units)})$", "examples": [example]}
    return Annotated[
        float,
        BeforeValidator(read),
        *limits,
        Field(allow_inf_nan=False),
        PlainSerializer(lambda value: f"{value!r} {si}", when_used="json"),
        WithJsonSchema(schema),
    ]


_LENGTH = "a length", quantities.length, quantities.LENGTHS
_ANGLE = "an angle", quantities.angle, quantities.ANGLES

Length = _quantity(*_LENGTH, "-4 cm", Ge(-100.0), Le(100.0))
Size = _quantity(*_LENGTH, "4 cm", Gt(0.0), Le(100.0))
Amount = _quantity(*_LENGTH, "0.2 mm", Ge(0.0), Le(100.0))
Angle = _quantity(*_ANGLE, "-3 deg", Ge(-100.0), Le(100.0))
Range = _quantity(*_ANGLE, "40 deg", Gt(0.0), Lt(3.15))
Turn = _quantity(*_ANGLE, "0.02 deg", Ge(0.0), Le(3.15))
Compliance = _quantity(
    "a compliance", quantities.compliance, quantities.COMPLIANCES, "0.0002 rad/Nm", Ge(0.0), Le(1.0)
)

Count = Annotated[int, Field(strict=True, ge=1, le=MOST)]
Seed = Annotated[int, Field(strict=True, ge=0, lt=2**32)]
Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[Number, Field(gt=0, le=1e6)]
Share = Annotated[Number, Field(ge=0, lt=1)]
Fraction = Annotated[Number, Field(gt=0, le=1)]
Name = Annotated[str, Field(strict=True, pattern=NAME, max_length=60)]
Text = Annotated[str, Field(strict=True, min_length=1, max_length=300)]
Switch = Annotated[bool, Field(strict=True)]
