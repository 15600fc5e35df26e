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
from ruamel.yaml.constructor import SafeConstructor
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

from replication.config.messages import InvalidConfiguration, KeyPath

COMMAND_LINE = "the command line"
Place = tuple[str | int, ...]  # file, line, column


@dataclass(frozen=True)
class Placed:
    """A value and where it stands."""

    content: Any  # a scalar, or a mapping or a list of values
    place: Place  # of its key, where it has one

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
    match data:
        case Mapping():
            data = {str(key): from_mapping(part, place) for key, part in data.items()}
        case list() | tuple():
            data = [from_mapping(part, place) for part in data]
    return Placed(data, place)


def from_file(path: str | PathLike[str]) -> Placed:
    """Values of a YAML file. Raises InvalidConfiguration."""
    absolute, folder = Path(path).absolute(), Path.cwd()
    name = fspath(absolute.relative_to(folder) if absolute.is_relative_to(folder) else path)
    try:
        return _parsed(name, Path(path).read_text(encoding="utf-8-sig"))
    except MarkedYAMLError as error:
        problem = _unreadable(name, error)
    except OSError as error:
        problem = f"{name}: {error.strerror}"
    except (UnicodeDecodeError, YAMLError):
        problem = f"{name}: no text in UTF-8"
    except ValueError:
        problem = f"{name}: a value that is not what its tag says"
    except RecursionError:
        problem = f"{name}: an anchor within itself, or too many brackets"
    raise InvalidConfiguration([problem])


@cache  # several studies begin with one file
def _parsed(name: str, text: str) -> Placed:
    reader = YAML(typ="safe", pure=True)  # of YAML 1.2
    reader.Constructor = _Constructor
    start = (name, 1, 1)
    value = _with_places(reader.compose(text), reader.constructor, start)
    if not isinstance(value.content, dict) or not value.content:
        problem = f"{shown(start)}: no configuration; expected: keys with their values"
        raise InvalidConfiguration([problem])
    return value


class _Constructor(SafeConstructor):
    """Ruamel's, for which a date is text."""


_Constructor.add_constructor("tag:yaml.org,2002:timestamp", SafeConstructor.construct_scalar)


def _with_places(node: Node | None, reader: SafeConstructor, place: Place) -> Placed:
    """The values of a node. Raises MarkedYAMLError for a key that stands twice or is no text."""
    content: Any
    match node:
        case MappingNode():
            # an alias is met again, with what was merged in front
            own = [key for key, _ in node.value[len(node.merge or ()) :]]
            for index, key in enumerate(own):
                if key.value in [other.value for other in own[:index]]:
                    raise _mistaken(f"{key.value} stands twice", key)
            reader.flatten_mapping(node)  # what << merges comes first
            for key, _ in node.value:
                if not isinstance(key, ScalarNode):
                    raise _mistaken("a key that is no text", key)
            content = {
                key.value: _with_places(part, reader, _place(key, place))
                for key, part in node.value
            }
        case SequenceNode():
            content = [_with_places(part, reader, _place(part, place)) for part in node.value]
        case ScalarNode() if node.tag not in reader.yaml_constructors:
            raise InvalidConfiguration([f"{shown(place)}: no YAML: the tag {node.tag}"])
        case _:
            content = reader.construct_object(node) if node else None
    return Placed(content, place)


def _mistaken(problem: str, node: Node) -> MarkedYAMLError:
    return MarkedYAMLError(problem=problem, problem_mark=node.start_mark)


def _place(node: Node, within: Place) -> Place:
    return within[0], node.start_mark.line + 1, node.start_mark.column + 1


def _unreadable(name: str, error: MarkedYAMLError) -> str:
    """Ruamel's reason in a sentence."""
    context = f" in what begins in line {error.context_mark.line + 1}" if error.context_mark else ""
    mark = error.problem_mark
    problem = str(error.problem).strip()
    return f"{shown((name, mark.line + 1, mark.column + 1))}: no YAML: {problem}{context}"


def shown(place: Place) -> str:
    """A place as compilers write it."""
    return ":".join(map(str, place))
