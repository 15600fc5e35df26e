"""Types of values in a configuration, with ranges. For quantities see `recalib.files.bounded`.

Counts must be integers, not text or 4.0. `patternErrorMessage` gives editors the same text that
messages have.
"""

from collections.abc import Callable, Sequence
from typing import Annotated, Any, TypeVar

from pydantic import AfterValidator, Field, StringConstraints, ValidationError, WrapValidator
from pydantic_core import PydanticCustomError

MOST = 1_000_000  # iterations: more would run for days
MOST_TIMES = 10_000  # draws, runs or measurements


def _expected(valid: str) -> WrapValidator:
    """A validator that has one message for every wrong value: the description of valid ones."""

    def validated(value: Any, validate: Callable[[Any], Any]) -> Any:
        try:
            return validate(value)
        except ValidationError:
            raise PydanticCustomError("expected", valid) from None

    return WrapValidator(validated)


def _text(pattern: str, valid: str, longest: int) -> Any:
    return Annotated[
        str,
        StringConstraints(strict=True, pattern=pattern, max_length=longest),
        _expected(valid),
        Field(json_schema_extra={"patternErrorMessage": valid}),
    ]


Count = Annotated[int, Field(strict=True, ge=1, le=MOST)]
Times = Annotated[int, Field(strict=True, ge=1, le=MOST_TIMES)]
Several = Annotated[Times, Field(ge=2)]
Seed = Annotated[int, Field(strict=True, ge=0, le=2**32 - 1)]
Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Error = Annotated[Number, Field(ge=1e-6, le=1e4)]  # cm, mm, degrees; less would be rounding
Scale = Annotated[Number, Field(ge=1e-3, le=1e3)]
Fraction = Annotated[Number, Field(ge=1e-3, le=1)]
Name = _text(  # of a robot, a scenario, a learner: it becomes part of paths
    r"^[A-Za-z][A-Za-z0-9_]*$", "a name (letters, digits and _, beginning with a letter)", 60
)
StudyName = _text("^[a-z][a-z0-9_]*$", "a name (small letters, digits and _, a letter first)", 40)
Url = _text(r"^https://\S+$", "an address that begins with https://", 300)
Checksum = _text("^[0-9a-f]{64}$", "64 digits from 0 to f", 64)
Text = Annotated[str, Field(strict=True, min_length=1, max_length=300)]
Switch = Annotated[bool, Field(strict=True)]


def _distinct(values: Sequence[Any]) -> Sequence[Any]:
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
