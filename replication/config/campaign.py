"""Factors: choices that the paper leaves open, and their levels, the possible decisions.

The reason for each level is in config.yaml, next to it. The first level of each factor is that of
the reference study.
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
    """Ranges of settings in a search, up to the limits of the method."""

    widths: Ordered[Scale]
    """Widths of neighbourhoods, from the winner alone to all cells. The workspace is 2 wide."""
    rates: Ordered[Fraction]
    """Learning rates, in (0, 1]."""


class RoughSearch(Part):
    """A very rough search, like a search by hand."""

    trials: Times
    """Number of settings tried."""
    ranges: Ranges
    """Ranges of settings that one would try by hand."""


class Factors(Part):
    """The factors, each with its levels."""

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
    """The reference study, and setups with other decisions on what the paper leaves open."""

    setups: Several
    """Number of setups; setup 0 is the reference study."""
    replicated: Times
    """Number of setups, from the first, that are measured `replicates` times."""
    replicates: Several
    """Measurements of such a setup, each with its own searches, poses and runs."""
    seed: Seed
    """Seed of the design."""
    factors: Factors
    """Choices that the paper leaves open."""
    home_spread: Turn
    """Greatest distance of each joint in a random home from the configured home."""
    longer: Size
    """Extra length of a longer tool, on the study's own robot."""
    runs: Several
    """Number of runs of a training over which errors are averaged."""
    rough: RoughSearch
    """A very rough search, like the paper's."""
    late: Count
    """Iterations after which Ritter's maps are compared with one another."""
    rungs: SomeDistinct[Count]
    """Further numbers of iterations after which Ritter's map may reach the improved system."""
    reference_rungs: SomeDistinct[Count]
    """In setup 0, iterations for which each step from Ritter's map to the improved one is tuned."""
