"""What the paper leaves open, and the ways in which it could be decided.

The reason for a level is next to it in config.yaml. The first level of each factor is that of the
reference study.
"""

from typing import Literal

from recalib.files.bounded import Size, Turn
from replication.config.part import Part
from replication.config.units import (
    Count,
    Fraction,
    Name,
    Ordered,
    Scale,
    Seed,
    Several,
    SomeDistinct,
    Times,
)


class Ranges(Part):
    """From where to where settings are sought: to the edges of the method."""

    widths: Ordered[Scale]
    """Of a neighbourhood: the winner alone, and flat. The workspace is 2 wide."""
    rates: Ordered[Fraction]
    """Of learning, in (0, 1]."""


class RoughSearch(Part):
    """A very rough search, as by hand."""

    trials: Times
    """Settings tried."""
    ranges: Ranges
    """Of settings that one would try."""


class Factors(Part):
    """Each of them by its levels."""

    robot: SomeDistinct[Name]
    """Robot; the proportions of its workspace are those of the study's own."""
    home: SomeDistinct[Literal["configured", "random"]]
    """Centre of the workspace."""
    assignment: SomeDistinct[Literal["nearest", "any"]]
    """Links, encoders and signs of the paper's damage."""
    shortening: SomeDistinct[Literal["line", "axis"]]
    """Direction in which a link is shortened."""
    coordinates: SomeDistinct[Literal["roll_pitch_yaw", "rotation_vector"]]
    """Coordinates of orientations."""
    norm: SomeDistinct[Literal["half_ranges", "metres_radians", "centimetres_degrees"]]
    """Units of poses in the norm in (3) and (8)."""
    centres: SomeDistinct[Literal["boxes", "faces"]]
    """Centres of the cells."""
    dimensions: SomeDistinct[Literal[3, 6]]
    """The exponent n in (10)."""
    spread: SomeDistinct[Literal["widths", "logarithms"]]
    """Steps of widths that are visited equally."""
    rate: SomeDistinct[Literal["exponential", "linear"]]
    """Decay of the learning rate of Ritter's algorithm."""
    error: SomeDistinct[Literal["norm", "coordinates"]]
    """Definition of the errors of a pose."""
    widths: SomeDistinct[Literal["half_ranges", "centimetres_degrees"]]
    """Units of the widths of neighbourhoods."""
    order: SomeDistinct[Literal["random", "even"]]
    """Order of the poses to learn from."""
    tool: SomeDistinct[Literal["flange", "longer"]]
    """Tool."""


class Campaign(Part):
    """Setups that decide otherwise what the paper leaves open, and the reference study."""

    setups: Several
    """Setups; number 0 is the reference study."""
    replicated: Times
    """So many of them, the first ones, are measured `replicates` times."""
    replicates: Several
    """Measurements of such a setup, each with searches, poses and runs of its own."""
    seed: Seed
    """Of their design."""
    factors: Factors
    """What the paper leaves open."""
    home_spread: Turn
    """How far from the configured home each joint of a random one may be."""
    longer: Size
    """By which a longer tool goes on, on the study's own robot."""
    runs: Several
    """Runs of a training of which the errors are means."""
    rough: RoughSearch
    """A very rough search, like the paper's."""
    late: Count
    """Iterations after which Ritter's maps are compared with one another."""
    rungs: SomeDistinct[Count]
    """Further iterations at which Ritter's map is sought that reaches the improved system."""
    reference_rungs: SomeDistinct[Count]
    """Iterations for which every step from Ritter's map to the improved system is tuned at home."""
