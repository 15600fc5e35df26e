"""The entries of a scenario: damages and disturbances, read and written by one type."""

from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import Annotated, Any, Literal, Union

from pydantic import ConfigDict, Discriminator, Tag, TypeAdapter, with_config

from recalib.damaged.bending import LinkBend, LinkTwist
from recalib.damaged.damage import BaseShift, Damage, EncoderShift, LinkShortening
from recalib.damaged.disturbances import Disturbances, Noise, Outliers, Repeatability
from recalib.damaged.imperfections import Imperfection
from recalib.damaged.nongeometric import Backlash, EccentricGear, Sag
from replication.config.part import Part


class Assigned(Part):
    """A part of the paper's damage, as it is assigned to the robot."""

    assigned: Literal["links", "encoders"]
    """That part of the paper's damage."""

    def part_of(self, assignment: Iterable[Damage]) -> list[Damage]:
        """Those damages of an assignment that are meant."""
        kind = LinkShortening if self.assigned == "links" else EncoderShift
        return [damage for damage in assignment if isinstance(damage, kind)]
