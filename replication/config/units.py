"""Values of the configuration as types: each knows its unit and range, and reads what it writes.

Quantities are text such as `4 cm` and become SI numbers. Counts are whole numbers, no text, no 4.0.
What would be valid is said to editors (`patternErrorMessage`) as in messages.
"""

from collections.abc import Callable, Sequence
from typing import Annotated, Any, TypeVar

from annotated_types import Ge, Gt, Le, Lt
from pydantic import (
    AfterValidator,
    Field,
    PlainSerializer,
    StringConstraints,
    ValidationError,
    WithJsonSchema,
    WrapValidator,
)
from pydantic_core import PydanticCustomError

from recalib.errors import InvalidQuantity
from recalib.files.quantities import ANGLE, COMPLIANCE, LENGTH, Quantity

MOST = 1_000_000  # iterations: more would run for days
MOST_TIMES = 10_000  # of what is drawn, done or measured again and again


def _expected(valid: str, read: Callable[[Any], Any] = lambda value: value) -> WrapValidator:
    """Reads a value before its type does. Whatever is wrong with it, `valid` is what is said."""

    def told(value: Any, validate: Callable[[Any], Any]) -> Any:
        try:
            return validate(read(value))
        except (InvalidQuantity, ValidationError):
            raise PydanticCustomError("expected", valid) from None

    return WrapValidator(told)


def _quantity(quantity: Quantity, limits: str, example: str, *bounds: Any) -> Any:
    """The type of text such as `4 cm` that becomes a number of SI units within the bounds."""
    valid = f"{quantity.name} {limits}, such as '{example}' ({', '.join(quantity.units)})"
    pattern = rf"^\s*[-+]?\d.*({'|'.join(quantity.units)})\s*$"
    return Annotated[
        float,
        *bounds,
        _expected(valid, quantity.read),
        PlainSerializer(quantity.write, when_used="json"),
        WithJsonSchema({"type": "string", "pattern": pattern, "patternErrorMessage": valid}),
    ]


def _text(pattern: str, valid: str, longest: int) -> Any:
    """The type of text that follows a pattern."""
    return Annotated[
        str,
        StringConstraints(strict=True, pattern=pattern, max_length=longest),
        _expected(valid),
        Field(json_schema_extra={"patternErrorMessage": valid}),
    ]


Length = _quantity(LENGTH, "from -100 to 100 m", "-4 cm", Ge(-100.0), Le(100.0))
Size = _quantity(LENGTH, "above 0 and up to 100 m", "4 cm", Gt(0.0), Le(100.0))
Amount = _quantity(LENGTH, "from 0 to 100 m", "0.2 mm", Ge(0.0), Le(100.0))
Angle = _quantity(ANGLE, "from -100 to 100 rad", "-3 deg", Ge(-100.0), Le(100.0))
Turn = _quantity(ANGLE, "from 0 to 180 deg", "0.02 deg", Ge(0.0), Le(3.15))
SignedTurn = _quantity(ANGLE, "from -180 to 180 deg", "-3 deg", Ge(-3.15), Le(3.15))
# of what is random: in more no arm and no instrument would be of use
Noise = _quantity(LENGTH, "from 0 to 10 cm", "0.2 mm", Ge(0.0), Le(0.1))
NoiseOfTurn = _quantity(ANGLE, "from 0 to 10 deg", "0.02 deg", Ge(0.0), Le(0.175))
# of a workspace: in units of a smaller one, damages would be out of all proportion
Side = _quantity(LENGTH, "from 1 mm to 100 m", "40 cm", Ge(1e-3), Le(100.0))
Range = _quantity(ANGLE, "from 0.1 to 180 deg", "40 deg", Ge(1e-3), Lt(3.15))
Compliance = _quantity(COMPLIANCE, "from 0 to 1 rad/Nm", "0.0002 rad/Nm", Ge(0.0), Le(1.0))

Count = Annotated[int, Field(strict=True, ge=1, le=MOST)]
Times = Annotated[int, Field(strict=True, ge=1, le=MOST_TIMES)]
Several = Annotated[Times, Field(ge=2)]
Seed = Annotated[int, Field(strict=True, ge=0, le=2**32 - 1)]
Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Error = Annotated[Number, Field(ge=1e-6, le=1e4)]  # cm, mm, degrees: less is rounding
Scale = Annotated[Number, Field(ge=1e-3, le=1e3)]
Share = Annotated[Number, Field(ge=0, lt=1)]
Fraction = Annotated[Number, Field(ge=1e-3, le=1)]
Name = _text(  # of a robot, a scenario, a learner: it becomes part of paths
    r"^[A-Za-z][A-Za-z0-9_]*$", "a name (letters, digits and _, beginning with a letter)", 60
)
StudyName = _text("^[a-z][a-z0-9_]*$", "a name (small letters, digits and _, a letter first)", 40)
SeriesName = _text("^[a-z]+$", "a name of small letters", 40)
Url = _text(r"^https://\S+$", "an address that begins with https://", 300)
Checksum = _text("^[0-9a-f]{64}$", "64 digits from 0 to f", 64)
Text = Annotated[str, Field(strict=True, min_length=1, max_length=300)]
Switch = Annotated[bool, Field(strict=True)]


def _distinct(values: Sequence) -> Sequence:
    twice = next((value for index, value in enumerate(values) if value in values[:index]), None)
    if twice is not None:
        raise PydanticCustomError("distinct", "each once, not {twice} twice", {"twice": twice})
    return values


def _ordered(values: tuple[float, float]) -> tuple[float, float]:
    if values[0] > values[1]:
        raise PydanticCustomError("ordered", "the lower value first")
    return values


Each = TypeVar("Each")
_UNIQUE = AfterValidator(_distinct), Field(json_schema_extra={"uniqueItems": True})
Distinct = Annotated[tuple[Each, ...], *_UNIQUE]
SomeDistinct = Annotated[tuple[Each, ...], Field(min_length=1), *_UNIQUE]
Ordered = Annotated[tuple[Each, Each], AfterValidator(_ordered)]
