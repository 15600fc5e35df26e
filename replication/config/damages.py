"""The entries of a scenario: damages, disturbances, and parts of the paper's damage."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal

from pydantic import TypeAdapter

from recalib.damaged.damage import Damage, EncoderShift, LinkShortening
from recalib.damaged.imperfections import Imperfection


@dataclass(frozen=True)
class Assigned(Imperfection, words=("assigned",)):
    """A part of the paper's damage, as assigned to the robot."""

    assigned: Literal["links", "encoders"]
    """The part of the paper's damage."""

    def part_of(self, assignment: Iterable[Damage]) -> list[Damage]:
        """The damages of an assignment that belong to this part."""
        kind = LinkShortening if self.assigned == "links" else EncoderShift
        return [damage for damage in assignment if isinstance(damage, kind)]


Entry = Imperfection  # an entry of a scenario: any kind of `recalib.damaged`, or Assigned
_ENTRY = TypeAdapter(Entry)


def describe(entry: Entry) -> dict[str, Any]:
    """An entry's keys and values in a configuration, without default values."""
    return _ENTRY.dump_python(entry, mode="json")


def link_of(entry: Entry) -> str:
    """The damaged link; empty if there is none."""
    return getattr(entry, "link", "")


def joint_of(entry: Entry) -> str:
    """The damaged joint; empty if there is none."""
    return getattr(entry, "joint", "") or getattr(entry, "encoder", "")


def damages_among(entries: Iterable[Entry]) -> list[Damage]:
    """The damages among a scenario's entries."""
    return [entry for entry in entries if isinstance(entry, Damage)]
