"""The entries of a scenario: damages, what disturbs a robot, and the paper's damage as assigned."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal

from pydantic import TypeAdapter

from recalib.damaged.damage import Damage, EncoderShift, LinkShortening
from recalib.damaged.imperfections import Imperfection


@dataclass(frozen=True)
class Assigned(Imperfection, words=("assigned",)):
    """A part of the paper's damage, as it is assigned to the robot."""

    assigned: Literal["links", "encoders"]
    """That part of the paper's damage."""

    def part_of(self, assignment: Iterable[Damage]) -> list[Damage]:
        """Those damages of an assignment that are meant."""
        kind = LinkShortening if self.assigned == "links" else EncoderShift
        return [damage for damage in assignment if isinstance(damage, kind)]


Entry = Imperfection  # of a scenario: any kind of `recalib.damaged`, or Assigned
_ENTRY = TypeAdapter(Entry)


def describe(entry: Entry) -> dict[str, Any]:
    """The keys and values that are read as this entry, without those that are as by default."""
    return _ENTRY.dump_python(entry, mode="json")


def link_of(entry: Entry) -> str:
    """The link that a damage is at; empty if it is at none."""
    return getattr(entry, "link", "")


def joint_of(entry: Entry) -> str:
    """The joint that a damage is at; empty if it is at none."""
    return getattr(entry, "joint", "") or getattr(entry, "encoder", "")


def damages_among(entries: Iterable[Entry]) -> list[Damage]:
    """The damages of a scenario's entries."""
    return [entry for entry in entries if isinstance(entry, Damage)]
