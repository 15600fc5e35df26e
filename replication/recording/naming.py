"""What damages an arm or disturbs it, in the words of texts and of the table of recordings."""

from typing import Any

from recalib.damaged.damage import LinkShortening
from replication.config.damages import Entry, describe


def link_of(entry: Entry) -> str:
    """The link that a damage is at; empty if it is at none."""
    return getattr(entry, "link", "")


def joint_of(entry: Entry) -> str:
    """The joint that a damage is at; empty if it is at none."""
    return getattr(entry, "joint", "")


def name(part: str) -> str:
    """A link or joint as people call it."""
    return part.removesuffix("_link").removesuffix("_joint").replace("_", " ")


def in_words(entry: Entry) -> str:
    """A damage or disturbance: where it is, what it is, and by how much."""
    words = describe(entry)
    if not (part := link_of(entry) or joint_of(entry)):
        return _joined(words)
    (key, _), (_, value), *details = words.items()
    amount = f"{value} short" if isinstance(entry, LinkShortening) else f"{key} {value}"
    return f"{name(part)}: {', '.join(filter(None, [amount, _joined(dict(details))]))}"


def _joined(words: Any) -> str:
    match words:
        case dict():
            return ", ".join(f"{key} {_joined(value)}" for key, value in words.items())
        case list():
            return ", ".join(words)
    return str(words)
