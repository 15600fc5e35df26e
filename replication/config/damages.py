"""The entries of a scenario: words in the configuration, damages and disturbances in the code.

Words, meanings and units stand beside the fields of the damage's class (`recalib.damaged.words`).
"""

import builtins
import dataclasses
from collections.abc import Callable, Iterable, Mapping
from types import GenericAlias
from typing import TYPE_CHECKING, Annotated, Any, Literal, Union, get_origin

from pydantic import Discriminator, Field, PlainSerializer, Tag, WrapValidator, create_model

from recalib.damaged.damage import Damage, EncoderShift, LinkShortening
from recalib.damaged.disturbances import Disturbances, Noise, Repeatability
from recalib.damaged.kinds import DAMAGES, DISTURBANCES
from recalib.damaged.words import Described, words
from recalib.files.quantities import ANGLE, COMPLIANCE, LENGTH
from recalib.spelling import listed, nearest
from replication.config import units
from replication.config.part import Frozen, Part


class Assigned(Part):
    """A part of the paper's damage, as it is assigned to the robot."""

    assigned: Literal["links", "encoders"]
    """That part of the paper's damage."""

    def part_of(self, assignment: Iterable[Damage]) -> list[Damage]:
        """Those damages of an assignment that are meant."""
        kind = LinkShortening if self.assigned == "links" else EncoderShift
        return [damage for damage in assignment if isinstance(damage, kind)]


_TYPES = {
    (LENGTH, True): units.Length,
    (LENGTH, False): units.Amount,
    (ANGLE, True): units.SignedTurn,
    (ANGLE, False): units.Turn,
    (COMPLIANCE, False): units.Compliance,
}
_RANDOM = {(LENGTH, False): units.Noise, (ANGLE, False): units.NoiseOfTurn}


def _model(kind: type[Described]) -> type[Frozen]:
    """The words of a damage or a disturbance as a part of the configuration."""
    said: dict[str, Any] = {}
    types = _TYPES | (_RANDOM if kind in (Noise, Repeatability) else {})
    for field in dataclasses.fields(kind):
        word = words(kind)[field.name]
        its_type: Any
        number = types[word.quantity, word.signed] if word.quantity else units.Share
        match get_origin(field.type):
            case None:
                its_type = units.Text if field.type is str else number
            case builtins.tuple:
                its_type = GenericAlias(tuple, (number,) * 3)
            case _:  # a choice
                its_type = field.type
        default = ... if field.default is dataclasses.MISSING else field.default
        said[word.key] = its_type, Field(default, description=word.meaning)
    inner = create_model(kind.__name__, __base__=Frozen, __doc__=kind.__doc__, **said)
    if kind.under is None:
        return inner
    outer: dict[str, Any] = {kind.under: (inner, Field(description=kind.__doc__))}
    return create_model(f"{kind.__name__}Entry", __base__=Frozen, __doc__=kind.__doc__, **outer)


def _choice(kind: type[Described], model: type[Frozen]) -> Any:
    """The type of an entry that is such a damage: reads its words, takes it as it is."""

    def read(value: Any, validate: Callable[[Any], Frozen]) -> Described:
        if isinstance(value, kind):
            return value
        read = validate(value)
        said = getattr(read, kind.under) if kind.under else read
        return kind(**{name: getattr(said, word.key) for name, word in words(kind).items()})

    return Annotated[model, WrapValidator(read), Tag(model.__name__)]


_MODELS: dict[type[Described], type[Frozen]] = {
    kind: _model(kind) for kind in (*DAMAGES, *DISTURBANCES)
}
_WITH_ASSIGNED: list[type[Frozen]] = [*_MODELS.values(), Assigned]
_BY_KEY = {key: model for model in _WITH_ASSIGNED for key in model.model_fields}


def _name_of(value: Any) -> str | None:
    """The kind that an entry is meant to be: by the first of its words that is one, or nearly."""
    if not isinstance(value, Mapping):
        kind = type(value)
        return _MODELS[kind].__name__ if kind in _MODELS else kind.__name__
    exact = next((key for key in value if key in _BY_KEY), None)
    suggested = (nearest(str(key), _BY_KEY) for key in value)
    meant = exact or next(filter(None, suggested), None)
    return _BY_KEY[meant].__name__ if meant else None


def describe(entry: "Entry") -> dict[str, Any]:
    """The words that read as just this entry. What is as by default is left out."""
    if isinstance(entry, Assigned):
        return {"assigned": entry.assigned}
    said: dict[str, Any] = {}
    default: dict[str, Any] = {}
    for field in dataclasses.fields(entry):
        word, value = words(type(entry))[field.name], getattr(entry, field.name)
        write = word.quantity.write if word.quantity else lambda value: value
        text = [write(part) for part in value] if isinstance(value, tuple) else write(value)
        (default if value == field.default else said)[word.key] = text
    said = said or default  # nothing at all would say nothing
    return {entry.under: said} if entry.under else said


if TYPE_CHECKING:
    Entry = Described | Assigned
else:
    Entry = Annotated[
        Union[
            *(_choice(kind, model) for kind, model in _MODELS.items()),
            Annotated[Assigned, Tag(Assigned.__name__)],
        ],
        Discriminator(
            _name_of,
            custom_error_type="entry",
            custom_error_message=f"a mapping that begins with {listed(_BY_KEY, 'or')}",
        ),
        PlainSerializer(describe),
    ]


def damages_among(entries: Iterable[Entry]) -> list[Damage]:
    """The damages of a scenario's entries."""
    return [entry for entry in entries if isinstance(entry, Damage)]


def disturbances_among(entries: Iterable[Entry]) -> Disturbances | None:
    """What disturbs moves and measurements, if anything."""
    parts = [entry for entry in entries if isinstance(entry, DISTURBANCES)]
    return Disturbances.of(parts) if parts else None
