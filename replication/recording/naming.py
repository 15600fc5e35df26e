"""What is wrong with an arm, in the words of labels, texts and the table of recordings."""

from collections.abc import Mapping
from typing import Any

from recalib.damaged.damage import Damage, EncoderShift, LinkShortening
from replication.config.damages import Entry, describe

PARTS = "link", "joint", "encoder"  # keys of what a damage is at


def part_of(damage: Damage) -> str:
    """The link or joint that a damage is at; a base has no name."""
    return next((getattr(damage, key) for key in PARTS if hasattr(damage, key)), "")


def name(part: str) -> str:
    """A link or joint as people call it."""
    return part.removesuffix("_link").removesuffix("_joint").replace("_", " ")


def amount(damage: Damage) -> str:
    """What is wrong with the link or joint of a damage, and by how much."""
    (key, value), *_ = _details(damage).items()
    match damage:
        case LinkShortening():
            return f"{value} short"
        case EncoderShift():
            return f"encoder {value}"
    return _joined({key: value})


def in_words(entry: Entry) -> str:
    """What is wrong with an arm, or disturbs it."""
    details = _details(entry)
    if not isinstance(entry, Damage) or not part_of(entry):
        return _joined(details)
    others = dict([*details.items()][1:])
    return f"{name(part_of(entry))}: {', '.join(filter(None, [amount(entry), _joined(others)]))}"


def _details(entry: Entry) -> dict[str, Any]:
    """An entry without the link or joint that it is at."""
    return {key: value for key, value in describe(entry).items() if key not in PARTS}


def _joined(details: Mapping[str, Any]) -> str:
    return ", ".join(
        f"{key.replace('_', ' ')} {', '.join(value) if isinstance(value, list) else value}"
        for key, value in details.items()
    )
