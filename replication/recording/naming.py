"""What is wrong with an arm, in the words of labels, texts and the table of recordings."""

from typing import Any

from recalib.damaged.damage import Damage, LinkShortening
from replication.config.damages import Entry, describe


def part_of(damage: Damage) -> str:
    """The link or joint that a damage is at; a base has no name."""
    return getattr(damage, "link", "") or getattr(damage, "joint", "")


def name(part: str) -> str:
    """A link or joint as people call it."""
    return part.removesuffix("_link").removesuffix("_joint").replace("_", " ")


def amount(damage: Damage) -> str:
    """What is wrong with the link or joint of a damage, and by how much."""
    (key, _), (_, value), *_ = describe(damage).items()
    return f"{value} short" if isinstance(damage, LinkShortening) else f"{key} {value}"


def in_words(entry: Entry) -> str:
    """What is wrong with an arm, or disturbs it."""
    if not isinstance(entry, Damage) or not part_of(entry):
        return _joined(describe(entry))
    details = dict([*describe(entry).items()][2:])
    return f"{name(part_of(entry))}: {', '.join(filter(None, [amount(entry), _joined(details)]))}"


def _joined(words: Any) -> str:
    match words:
        case dict():
            return ", ".join(f"{key} {_joined(value)}" for key, value in words.items())
        case list():
            return ", ".join(words)
    return str(words)
