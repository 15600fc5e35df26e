"""The multiverse: what the paper leaves open, and the ways in which it could be decided.

A level's reason stands beside it in config.yaml.
"""

from typing import Literal

from recalib.study.configuration.part import Part
from recalib.study.configuration.units import (
    Count,
    Name,
    Seed,
    Several,
    Size,
    SomeDistinct,
    Times,
    Turn,
)


class Factors(Part):
    """Each of them by its levels."""

    robot: SomeDistinct[Name]
    """Robots whose workspaces have the proportions of the study's own."""
    home: SomeDistinct[Literal["configured", "random"]]
    """The centre of the workspace."""
    assignment: SomeDistinct[Literal["nearest", "any"]]
    """The one nearest to the published errors, or any, of the paper's damage."""
    shortening: SomeDistinct[Literal["line", "axis"]]
    """Along what a link is shortened."""
    coordinates: SomeDistinct[Literal["roll_pitch_yaw", "rotation_vector"]]
    """By which orientations are given."""
    norm: SomeDistinct[Literal["half_ranges", "metres_radians", "centimetres_degrees"]]
    """The units of pose coordinates in the norm in (3) and (8)."""
    centres: SomeDistinct[Literal["boxes", "faces"]]
    """Where the centres of the cells lie."""
    dimensions: SomeDistinct[Literal[3, 6]]
    """n in (10)."""
    spread: SomeDistinct[Literal["widths", "logarithms"]]
    """What equal visits are spread over evenly."""
    displacement: SomeDistinct[Literal["configured", "random"]]
    """The directions in which the whole robot is moved and turned."""
    rate: SomeDistinct[Literal["exponential", "linear"]]
    """How Ritter's learning rate falls."""
    cells: SomeDistinct[Literal["each", "whole"]]
    """Whether each map has the cells of the nets, or all maps of a learner as a whole."""
    score: SomeDistinct[Literal["worse", "geometric_mean"]]
    """What the search minimises."""
    effort: SomeDistinct[Literal["full", "rough"]]
    """Of a search."""
    ranges: SomeDistinct[Literal["ours", "wider"]]
    """Of a search."""
    initial: SomeDistinct[Literal["identity", "random"]]
    """What theta starts from where its values are propagated."""
    error: SomeDistinct[Literal["norm", "coordinates"]]
    """The error of a pose."""
    widths: SomeDistinct[Literal["half_ranges", "centimetres_degrees"]]
    """The units of the widths of neighbourhoods."""
    order: SomeDistinct[Literal["random", "even"]]
    """Of the poses to learn from."""
    tool: SomeDistinct[Literal["flange", "longer"]]
    """Where the tool ends."""


class Universes(Part):
    """A sample of all defensible readings of the paper, balanced over their factors."""

    count: Times
    """Universes."""
    seed: Seed
    """Of their design."""
    factors: Factors
    """What the paper leaves open."""
    home_spread: Turn
    """How far from the configured home each joint of a random one may be."""
    longer: Size
    """By which a longer tool goes on, on the study's own robot."""
    assignment_poses: Times
    """Random poses over which initial errors are averaged to find the nearest assignment."""
    rough_trials: Times
    """Trials of a rough search, in a single round."""
    rungs: SomeDistinct[Count]
    """Numbers of iterations at which the horizon of Ritter's algorithm is sought, ascending."""
    seeds: Times
    """Seeds of a training."""
    replicates: Several
    """Measurements of a universe, each with other searches, poses and seeds."""

    @property
    def horizons(self) -> list[int]:
        """The universes in which that horizon is sought: half of them.

        In the first half of the sequence some choices pass for others; in these none does.
        """
        return [number for number in range(self.count) if number % 4 in (0, 3)]
