"""Base class of damages and of disturbances: differences between a real arm and its model.

The fields of a class are the keys of a configuration entry: {link: forearm_link, shorten: 4 cm}.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import MISSING, dataclass, fields
from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, get_type_hints

import recalib.damaged
from recalib.files.bounded import Bounded
from recalib.spelling import listed, nearest

if TYPE_CHECKING:
    from pydantic_core import CoreSchema


@dataclass(frozen=True)
class Named:
    """Annotation of a name with its meaning, for editors and messages."""

    meaning: str

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        return {**handler(schema), "description": self.meaning}


Link = Annotated[str, Named("A link of the robot.")]
Joint = Annotated[str, Named("A joint of the robot.")]


@dataclass(frozen=True)
class Imperfection:
    """Base of frozen dataclasses; each subclass is a new kind. Amounts are in SI units.

    A configuration field of this type accepts every kind; the keys of an entry select the kind.

    Attributes:
        kinds: every kind, under each of its identifying fields (`words`).

    Raises InvalidSetting if an amount is outside the bounds of its type.
    """

    kinds: ClassVar[dict[str, type["Imperfection"]]] = {}
    __pydantic_config__: ClassVar[dict[str, Any]] = {
        "extra": "forbid",
        "use_attribute_docstrings": True,
    }

    def __init_subclass__(cls, words: Iterable[str] = ()) -> None:
        """Args: words: fields that identify this kind; none for a base class of kinds."""
        super().__init_subclass__()
        for word in words:
            if word in cls.kinds:
                raise TypeError(f"{cls.__name__}: {cls.kinds[word].__name__} has {word}, too")
            cls.kinds[word] = cls

    def __post_init__(self) -> None:
        for name, bounds in self.bounds().items():
            value = getattr(self, name)
            for amount in value if isinstance(value, tuple) else (value,):
                bounds.check(f"{type(self).__name__}.{name}", amount)

    @classmethod
    @cache
    def bounds(cls) -> Mapping[str, Bounded]:
        """Bounds of each field that holds a quantity or three of them."""
        hints = get_type_hints(cls, include_extras=True)
        return {
            field.name: note
            for field in fields(cls)
            for note in _notes(hints[field.name])
            if isinstance(note, Bounded)
        }

    def amounts(self) -> list[str]:
        """The fields that hold its size, in contrast to its direction."""
        return [name for name, bounds in self.bounds().items() if not bounds.direction]

    @classmethod
    def __get_pydantic_core_schema__(cls, source: Any, handler: Any) -> "CoreSchema":
        from pydantic_core import PydanticCustomError, core_schema

        if cls is not Imperfection:
            schema: Any = handler(source)
            schema["serialization"] = core_schema.wrap_serializer_function_ser_schema(_short)
            return schema

        def known(value: Any) -> Any:
            if _kind_of(value) is None:
                forms = listed(_forms(value), "or")
                raise PydanticCustomError("kind", f"one of {forms}")
            return value

        for module in iter_modules(recalib.damaged.__path__):
            import_module(f"recalib.damaged.{module.name}")  # this registers its kinds
        choices = {kind.__name__: handler.generate_schema(kind) for kind in _kinds()}
        union = core_schema.tagged_union_schema(choices, _kind_of)
        return core_schema.no_info_before_validator_function(known, union)


def _kinds() -> list[type[Imperfection]]:
    return sorted({*Imperfection.kinds.values()}, key=lambda kind: kind.__name__)


def _kind_of(value: Any) -> str | None:
    """The kind of an entry, by its first key that is, or resembles, an identifying field."""
    kinds = Imperfection.kinds
    if isinstance(value, Imperfection):
        return type(value).__name__
    if not isinstance(value, Mapping):
        return None
    exact = next((key for key in value if key in kinds), None)
    meant = exact or next(filter(None, (nearest(str(key), kinds) for key in value)), None)
    return kinds[meant].__name__ if meant else None


def _short(entry: Imperfection, write: Callable[[Imperfection], dict[str, Any]]) -> dict[str, Any]:
    """An entry without its default values, unless all of its fields have their defaults."""
    written = write(entry)
    default = {field.name for field in fields(entry) if getattr(entry, field.name) == field.default}
    return {key: text for key, text in written.items() if key not in default} or written


def _forms(value: Any) -> list[str]:
    """The required keys of each kind; only of kinds that share a key with this value, if any do."""
    keys = {kind: [field.name for field in fields(kind)] for kind in _kinds()}
    given = {*value} if isinstance(value, Mapping) else set()
    alike = [kind for kind, names in keys.items() if given.intersection(names)]
    needed = {
        kind: [field.name for field in fields(kind) if field.default is MISSING] or keys[kind]
        for kind in alike or keys
    }
    return [f"{{{', '.join(names)}}}" for names in needed.values()]


def _notes(hint: Any) -> Iterator[Any]:
    """The annotations of a type, and of the first element of a tuple."""
    yield from getattr(hint, "__metadata__", ())
    for part in getattr(hint, "__args__", ())[:1]:
        yield from getattr(part, "__metadata__", ())
