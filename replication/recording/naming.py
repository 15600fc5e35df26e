"""What damages an arm or disturbs it, in the words of texts and of the table of recordings."""

from typing import Any

from recalib.damaged.damage import EncoderShift, LinkShortening
from replication.config.damages import Entry, describe

PARTS = "link", "joint", "encoder"  # keys of what a damage is at


def link_of(entry: Entry) -> str:
    """The link that a damage is at; empty if it is at none."""
    return getattr(entry, "link", "")


def joint_of(entry: Entry) -> str:
    """The joint that a damage is at; empty if it is at none."""
    return getattr(entry, "joint", "") or getattr(entry, "encoder", "")


def name(part: str) -> str:
    """A link or joint as people call it."""
    return part.removesuffix("_link").removesuffix("_joint").replace("_", " ")


def in_words(entry: Entry) -> str:
    """A damage or disturbance: where it is, what it is, and by how much."""
    words = {key: _value(value) for key, value in describe(entry).items() if key not in PARTS}
    said = [f"{key.replace('_', ' ')} {value}" for key, value in words.items()]
    match entry:
        case LinkShortening():
            said[0] = f"{words['shorten']} short"
        case EncoderShift():
            said[0] = f"encoder {words['shift']}"
    part = link_of(entry) or joint_of(entry)
    return f"{name(part)}: {', '.join(said)}" if part else ", ".join(said)


def _value(value: Any) -> str:
    return ", ".join(value) if isinstance(value, list) else str(value)
