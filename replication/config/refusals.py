"""Convert pydantic's validation errors into mistakes: the key, its value, what was expected."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from functools import reduce
from operator import getitem
from typing import Any

from pydantic import ValidationError

from recalib.spelling import instead, listed, nearest
from replication.config.messages import EXPECTED, Mistake, unlike
from replication.config.schema import find, keys, meaning

KEY = "[key]"  # end of the location in pydantic's errors about keys that are no valid name
MISSING = " is missing: "
VALID = {  # by pydantic's type of error, where its message has terms of Python
    "bool_type": "true or false",
    "dict_type": "a mapping",
    "model_type": "a mapping",
    "string_too_long": "at most {max_length} characters",
    "string_too_short": "at least {min_length} character",
    "too_long": "{max_length} values",
    "too_short": "at least {min_length} item",
    "tuple_type": "a list",
}


def refusals(error: ValidationError, whole: Any) -> list[Mistake]:
    """Mistakes in the `whole` configuration, one for each key.

    A key that is misspelt is not also reported as missing.
    """
    mistakes, intended = {}, set()
    errors = error.errors(include_url=False)
    for refusal in sorted(errors, key=lambda detail: detail["type"] == "missing"):
        *parents, last = refusal["loc"]
        name = str(last)
        path, schema = find(parents if last == KEY else refusal["loc"])
        match refusal["type"]:
            case "extra_forbidden" | "unexpected_keyword_argument" if name[:1].isdigit():
                fault = ": a comma ended the number before; expected: a point"
                mistakes[path] = Mistake(path, fault)
            case "extra_forbidden" | "unexpected_keyword_argument":
                valid = keys(find(parents)[1])
                intended.add((*path[:-1], nearest(name, valid)))
                mistakes[path] = Mistake(path, f": unknown key; {instead(name, valid)}")
            case "missing" if path in intended:
                pass
            case "missing" if isinstance(last, int):  # a list that is too short
                values = reduce(getitem, path[:-1], whole)
                mistakes[path[:-1]] = unlike(path[:-1], values, f"{last + 1} values")
            case "missing":
                mistakes[path] = Mistake(path, f"{MISSING}{meaning(schema)}")
            case "too_short" if refusal["input"]:
                pass  # none of its values is valid, and each has its own mistake
            case _:
                mistakes.setdefault(path, unlike(path, refusal["input"], _expected(refusal)))
    return [*_together(mistakes.values(), whole)]


def _together(mistakes: Iterable[Mistake], whole: Any) -> Iterator[Mistake]:
    """Combine missing keys of one part, and wrong values of one list, into one mistake."""
    groups = defaultdict(list)
    for mistake in mistakes:
        missing = mistake.fault.startswith(MISSING)
        shared = missing or isinstance(mistake.path[-1], int)
        groups[mistake.path[:-1] if shared else mistake.path, missing].append(mistake)
    for (path, missing), group in groups.items():
        if len(group) == 1:
            yield group[0]
        elif missing:
            names = (str(mistake.path[-1]) for mistake in group)
            yield Mistake(path, f" lacks {listed(names, 'and')}")
        else:
            _, _, expected = group[0].fault.partition(EXPECTED)
            yield unlike(path, reduce(getitem, path, whole), f"each {expected}")


def _expected(refusal: Mapping[str, Any]) -> str:
    if valid := VALID.get(refusal["type"]):
        return valid.format_map(refusal.get("ctx", {}))
    message: str = refusal["msg"]
    return message.removeprefix("Input should be ")
