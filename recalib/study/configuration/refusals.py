"""What the types refuse, as mistakes: the key, what stood there, and pydantic's own words."""

import re

from pydantic import ValidationError

from recalib.spelling import instead, nearest
from recalib.study.configuration.messages import Mistake, unlike
from recalib.study.configuration.schema import find, keys, meaning

KEY = "[key]"  # how pydantic ends the place of a key that is no valid name
# What it says of Python, said of YAML.
SAID = {
    r"^\w+ should (be|have) ": "",
    r"a valid dictionary.*": "a mapping",
    "a valid tuple": "a list",
    "a valid boolean": "true or false",
    " after validation, not .*": "",
}


def refusals(error: ValidationError) -> list[Mistake]:
    """What is wrong with a configuration: a mistake for each key.

    A misspelt key is no missing one, too.
    """
    found, meant = {}, set()
    errors = error.errors(include_url=False)
    for refusal in sorted(errors, key=lambda its: its["type"] == "missing"):
        *parents, last = refusal["loc"]
        path, schema = find(parents if last == KEY else refusal["loc"])
        match refusal["type"]:
            case "extra_forbidden" if last[:1].isdigit():
                found[path] = Mistake(path, ": a comma ended the number before; expected: a point")
            case "extra_forbidden":
                valid = keys(find(parents)[1])
                meant.add((*path[:-1], nearest(last, valid)))
                found[path] = Mistake(path, f": unknown key; {instead(last, valid)}")
            case "missing" if path in meant:
                pass
            case "missing":
                found[path] = Mistake(path, f" is missing: {meaning(schema)}")
            case "too_short" if refusal["input"]:
                pass  # since none of its values is valid, which each of them says
            case _:
                found.setdefault(path, unlike(path, refusal["input"], _expected(refusal["msg"])))
    return list(found.values())


def _expected(message: str) -> str:
    for pattern, text in SAID.items():
        message = re.sub(pattern, text, message)
    return message
