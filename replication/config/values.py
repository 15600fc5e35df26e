"""YAML, read strictly: every value knows where it stands, and no key stands twice.

Words are those of YAML 1.2: `yes`, dates and 1:30 are text.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedKeyMap, CommentedKeySeq, CommentedMap, CommentedSeq
from ruamel.yaml.constructor import RoundTripConstructor
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.nodes import Node

from replication.config.messages import InvalidConfiguration, KeyPath

COMMAND_LINE = "the command line"
Place = tuple[str | int, ...]  # file, line, column


@dataclass(frozen=True)
class Placed:
    """A value and where it stands.

    Attributes:
        content: a scalar, or a mapping or a list of values.
        place: of its key, where it has one.
    """

    content: Any
    place: Place

    def plain(self) -> Any:
        """The same without places."""
        match self.content:
            case dict():
                return {key: value.plain() for key, value in self.content.items()}
            case list():
                return [value.plain() for value in self.content]
        return self.content

    def at(self, path: KeyPath) -> "Placed":
        """The value at a path, or the last one on the way to it."""
        value = self
        for part in path:
            try:
                value = value.content[part]
            except (KeyError, IndexError, TypeError):
                break
        return value

    def under(self, other: "Placed") -> "Placed":
        """This value with another laid over it: mappings key by key, anything else as a whole."""
        if not (isinstance(self.content, dict) and isinstance(other.content, dict)):
            return other
        laid = {
            key: self.content[key].under(value) if key in self.content else value
            for key, value in other.content.items()
        }
        return Placed(self.content | laid, self.place)


def from_mapping(data: Any, place: Place = (COMMAND_LINE,)) -> Placed:
    """Values that stand in no line of a file, such as those from the command line."""
    content: Any
    match data:
        case Mapping():
            content = {str(key): from_mapping(part, place) for key, part in data.items()}
        case list() | tuple():
            content = [from_mapping(part, place) for part in data]
        case _:
            content = data
    return Placed(content, place)


def from_file(path: str | PathLike[str]) -> Placed:
    """Values of a YAML file. Raises InvalidConfiguration."""
    whole, here = Path(path).absolute(), Path.cwd()
    name = fspath(whole.relative_to(here) if whole.is_relative_to(here) else path)
    try:
        return _parsed(name, Path(path).read_text(encoding="utf-8-sig"))
    except MarkedYAMLError as error:
        raise InvalidConfiguration([_unreadable(name, error)]) from None
    except (OSError, UnicodeDecodeError, YAMLError) as error:
        reason = error.strerror if isinstance(error, OSError) else "no text in UTF-8"
        raise InvalidConfiguration([f"{name}: {reason}"]) from None
    except ValueError:
        raise InvalidConfiguration([f"{name}: a value that is not what its tag says"]) from None
    except RecursionError:
        reason = "an anchor within itself, or too many brackets"
        raise InvalidConfiguration([f"{name}: {reason}"]) from None


@cache  # several studies begin with one file
def _parsed(name: str, text: str) -> Placed:
    reader = YAML()  # of YAML 1.2; it refuses a key that stands twice
    reader.Constructor = _Constructor
    start = (name, 1, 1)
    value = _with_places(reader.load(text), start)
    if not isinstance(value.content, dict) or not value.content:
        problem = f"{shown(start)}: no configuration; expected: keys with their values"
        raise InvalidConfiguration([problem])
    return value


class _Constructor(RoundTripConstructor):
    """Ruamel's, for which a date is text, and which names a key that stands twice."""

    def check_mapping_key(
        self, node: Node, key_node: Node, mapping: Mapping[Any, Any], key: Any, value: Any
    ) -> bool:
        """Raises MarkedYAMLError: the mapping has the key."""
        if key in mapping:
            raise MarkedYAMLError(problem=f"{key} stands twice", problem_mark=key_node.start_mark)
        return True


_Constructor.add_constructor(
    "tag:yaml.org,2002:timestamp", lambda reader, node: reader.construct_scalar(node)
)


def _with_places(value: Any, place: Place) -> Placed:
    """What ruamel read, with the places that it keeps beside."""
    content: Any
    match value:
        case CommentedMap():
            content = {}
            for key, part in value.items():
                at = _of_key(value, key, place)
                if isinstance(key, CommentedKeySeq | CommentedKeyMap):
                    raise InvalidConfiguration([f"{shown(at)}: no YAML: a key that is no text"])
                content[str(key)] = _with_places(part, at)
        case CommentedSeq():
            content = [
                _with_places(part, _from(place, *value.lc.item(index)))
                for index, part in enumerate(value)
            ]
        case bool() | None:
            content = value
        case int():
            content = int(value)
        case float():
            content = float(value)
        case str():
            content = str(value)
        case _:
            raise InvalidConfiguration([f"{shown(place)}: no YAML: the tag {value.tag.value}"])
    return Placed(content, place)


def _of_key(mapping: CommentedMap, key: str, place: Place) -> Place:
    """Where a key stands, itself or in what is merged by <<."""
    if key in (mapping.lc.data or ()):
        return _from(place, *mapping.lc.key(key))
    for merged in mapping.merge.value or ():
        if key in merged:
            return _of_key(merged, key, place)
    return place


def _from(place: Place, line: int, column: int) -> Place:
    return place[0], line + 1, column + 1


def _unreadable(name: str, error: MarkedYAMLError) -> str:
    """Ruamel's reason in a sentence."""
    begun = f" in what begins in line {error.context_mark.line + 1}" if error.context_mark else ""
    mark = error.problem_mark
    problem = str(error.problem).strip()
    return f"{shown((name, mark.line + 1, mark.column + 1))}: no YAML: {problem}{begun}"


def shown(place: Place) -> str:
    """A place as compilers write it."""
    return ":".join(map(str, place))
