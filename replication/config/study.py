"""A study as one typed value: every key of config.yaml, with its meaning, unit and range.

The shipped replication is one value of `Study`. Which trainings there are follows from it: see
`replication.training.plan`.
"""

import math
from collections.abc import Mapping as AnyMapping
from functools import cached_property
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field

from recalib.files.bounded import Amount, Angle, Range, Side, Size, Turn
from replication.config.campaign import Campaign, Ranges
from replication.config.damages import Entry
from replication.config.part import Part
from replication.config.switches import IMPROVED, RITTER, SWITCHES
from replication.config.units import (
    Checksum,
    Count,
    Distinct,
    Error,
    Fraction,
    Name,
    Number,
    Ordered,
    Scale,
    Seed,
    Several,
    SomeDistinct,
    StudyName,
    Switch,
    Text,
    Times,
    Url,
)

Filled = Field(min_length=1)


class WorkspaceSettings(Part):
    """Full size of the workspace."""

    position: tuple[Side, Side, Side]
    """Along the base's x, y and z."""
    orientation: tuple[Range, Range, Range]
    """Of roll, pitch and yaw, or along the axes of rotation vectors."""
    coordinates: Literal["roll_pitch_yaw", "rotation_vector"] = "roll_pitch_yaw"
    """By which orientations are given."""

    def scale_to(self, other: Self) -> float:
        """How large this one is, where the other is 1: the cube root of the ratio of volumes."""
        return round(math.cbrt(math.prod(self.position) / math.prod(other.position)), 4)


class RobotSettings(Part):
    """A nominal robot."""

    urdf: Text
    """File name of a URDF of example-robot-data, or a path from the project's folder."""
    tool: Text
    """Link whose frame is the pose."""
    beyond: Amount = 0.0
    """By which a rigid tool goes on outwards from there, along the last joint's axis."""
    home: Annotated[dict[str, Angle], Filled]
    """Joint angles at the centre of the workspace."""
    limits: dict[str, Ordered[Angle]] = Field(default={})
    """Joint limits that replace those of the URDF."""
    workspace: WorkspaceSettings
    """Full size of the workspace."""
    links: SomeDistinct[Text]
    """Links to which the paper's damage may be assigned."""


class ControllerSettings(Part):
    """The nominal controller."""

    greatest_condition: Annotated[Number, Field(gt=1, le=1e9)]
    """Largest condition number of the Jacobian that is accepted in the workspace."""


class Published(Part):
    """Initial errors in the paper."""

    position_error_cm: Error
    """In centimetres."""
    orientation_error_deg: Error
    """In degrees."""


class PaperDamage(Part):
    """The damage of section 7, whose links, encoders and signs are not published."""

    shorten: Annotated[tuple[Size, ...], Filled]
    """Lengths taken off as many links."""
    shift: Annotated[tuple[Annotated[Turn, Field(gt=0)], ...], Filled]
    """Angles by which as many encoders are shifted, in either direction."""
    published: Published
    """Initial errors in the paper."""
    poses: Times
    """Random poses over which initial errors are averaged."""


CellCount = Annotated[int, Field(strict=True, ge=1, le=20)]
Grid = tuple[CellCount, CellCount, CellCount]


class LearnerSettings(Part):
    """A learner of the paper: four switches, the sizes of its nets, and how long it is trained."""

    maps: Literal["single", "separate"]
    """One map for the whole command, or one for position and one for orientation (section 4)."""
    theta: Literal["values", "increments"]
    """What is propagated of theta (section 5)."""
    jacobian: Literal["values", "increments"]
    """What is propagated of the Jacobians (section 5)."""
    schedule: Literal["exponential", "equal_visits"]
    """Decay of widths and rate (section 6)."""
    supernet: Grid
    """Cells along x, y and z."""
    subnet: Grid
    """Cells along roll, pitch and yaw."""


class Ensemble(Part):
    """Robots with other assignments and other amounts of the paper's damage."""

    draws: Times
    """Assignments drawn."""
    scales: SomeDistinct[Scale]
    """Factors of all amounts."""


Lengths = SomeDistinct[Count]


class Experiments(Part):
    """Which learners are trained on which scenarios, for how many iterations."""

    scenarios: SomeDistinct[Name]
    """On the study's robot."""
    learners: Annotated[dict[Name, Lengths], Filled]
    """Trained on each of them, by learner."""
    robots: Distinct[Name]
    """Other robots on which they are trained, in the study's own scenario."""
    own: dict[Name, Distinct[Count]]
    """More trainings in the study's own scenario, by learner."""
    iterations: Count
    """Of Figure 1, and of the improved system with a switch changed."""
    switches: Switch
    """Whether to take each of the four changes from the improved system and add it to Ritter's."""
    evidence: Switch
    """Whether to judge and draw every claim of the paper, or those alone that trainings tell of."""
    ensemble: Ensemble
    """Robots with other assignments and amounts of the paper's damage."""


class Benchmark(Part):
    """The comparison of all learners in robot moves."""

    scenarios: SomeDistinct[Name]
    """On the study's robot."""
    learners: SomeDistinct[Name]
    """Today's learners."""
    papers: dict[Name, Count]
    """The paper's, each trained for so many iterations."""
    seeds: Several
    """Seeds of each learner on each scenario."""
    moves: SomeDistinct[Times]
    """Budgets of moves at which to measure."""
    longer: Distinct[Count]
    """More budgets, for trainings that go on."""
    thresholds: SomeDistinct[Error]
    """Errors to reach, in cm and degrees; the smallest of them is the page's."""


class Source(Part):
    """A recording of the real arm."""

    file: Text | None
    """A copy on this machine."""
    url: Url
    """The public address."""
    sha256: Checksum
    """Checksum of the file."""


class Recordings(Part):
    """The recordings to learn from and to test on."""

    fit: Source
    """Poses to learn from."""
    test: Source
    """Poses to test on."""


class PublishedReal(Part):
    """Mean position errors on the test poses, as published with the recordings."""

    before_mm: Error
    """Before calibration."""
    after_mm: Error
    """After a calibration from all poses."""


class Real(Part):
    """A real arm, whose recordings are not part of the project."""

    robot: Name
    """The nominal robot."""
    data: Recordings
    """Its recordings."""
    description: Text
    """What they do not say themselves: a file of the project."""
    published: PublishedReal
    """What was published with them."""
    learners: SomeDistinct[Name]
    """Those that can learn from recorded poses."""
    twin: dict[Name, Count]
    """The paper's, which choose their poses, and so learn on a twin for so many iterations."""
    poses: SomeDistinct[Several]
    """How many poses to learn from."""
    subsets: Several
    """Random subsets for each number of poses."""


class Mapping(Part):
    """Measurements of the true mapping, without a learner."""

    poses: Times
    """Where the Jacobian of the mapping is taken."""
    balls: Times
    """Balls of section 5."""
    points: Times
    """Random points of a ball."""
    radius: Fraction
    """Of a ball, in workspace coordinates."""
    scales: SomeDistinct[Scale]
    """Factors of the damage."""


class Measuring(Part):
    """On how many poses trainings are measured, and when."""

    tests: Times
    """Random poses for a measurement."""
    measure_every: Count
    """Iterations between two measurements."""
    measure_evenly: Count
    """Longer trainings are measured on a logarithmic grid."""
    measurements: Several
    """Points of that grid."""

    def during(self, iterations: int) -> list[int]:
        """After how many iterations to measure a training of so many."""
        if iterations <= self.measure_evenly:
            return sorted({*range(0, iterations, self.measure_every), iterations})
        grid = np.geomspace(1, iterations, self.measurements).round().astype(int)
        return sorted({0, *grid.tolist()})


class TrainingSettings(Measuring):
    """How trainings are run and measured."""

    seeds: Several
    """Seeds of each training."""


class SearchSettings(Part):
    """The search for widths and rates."""

    searches: Several
    """Independent searches for each training, with seeds and poses of their own."""
    seed: Seed
    """Of searches and their poses, which are used nowhere else."""
    ranges: Ranges
    """Of settings."""
    trials: Times
    """Settings that a search tries at first."""
    runs: Times
    """Runs over which a trial is averaged, each with poses of its own ..."""
    long: Count
    """... up to so many iterations; and in longer trainings:"""
    long_runs: Times
    """Runs."""
    near: Count
    """Longer trainings than this are sought near the winners of the next shorter ones."""
    near_trials: Times
    """Settings that such a search tries at first."""
    within: Fraction
    """Searches have converged when their winners differ by less, on fresh poses."""
    fresh: Several
    """Runs on fresh poses."""
    doublings: Annotated[int, Field(strict=True, ge=0, le=9)]
    """How often all searches may begin once more, with twice as many trials."""


class Study(Part):
    """Robot, damage, learners, settings, budgets and seeds: findings follow from it and code."""

    name: StudyName
    """`replication` is the shipped study; results of any other lie in results/studies/NAME."""
    seed: Seed
    """Of the whole study."""
    robot: Name
    """The study's robot, a key of robots."""
    scenario: Name
    """The study's own, the paper's damage: that of Figure 1, of the ladders and of the search."""
    settings: Literal["shipped", "own"]
    """Widths and rates: those searched for the shipped study, where there are any, or its own."""
    expected: Text | None
    """File with the bands in which final errors are expected; null: no check."""
    robots: Annotated[dict[Name, RobotSettings], Filled]
    """Robots by name."""
    controller: ControllerSettings
    """The nominal controller."""
    paper_damage: PaperDamage
    """The damage of section 7."""
    scenarios: Annotated[dict[Name, tuple[Entry, ...]], Filled]
    """Lists of damages by name."""
    learners: Annotated[dict[Name, LearnerSettings], Filled]
    """Learners of the paper by name."""
    experiments: Experiments
    """Which learners are trained on which scenarios."""
    benchmark: Benchmark
    """The comparison in robot moves."""
    real: Real
    """A real arm."""
    mapping: Mapping
    """Measurements of the true mapping."""
    training: TrainingSettings
    """How trainings are run and measured."""
    search: SearchSettings
    """The search for widths and rates."""
    campaign: Campaign
    """Setups that decide otherwise what the paper leaves open."""

    @cached_property
    def every_learner(self) -> AnyMapping[str, LearnerSettings]:
        """Every learner by name: the configured ones, and those with one switch changed."""
        named = dict(self.learners)
        if IMPROVED in named and RITTER in named:
            improved, ritter = named[IMPROVED], named[RITTER]
            for switch in SWITCHES:
                value, other = getattr(improved, switch.key), getattr(ritter, switch.key)
                named.setdefault(switch.without, improved.model_copy(update={switch.key: other}))
                named.setdefault(switch.added, ritter.model_copy(update={switch.key: value}))
            single = SWITCHES[0].without
            named[single] = self.doubled(named[single])
        return named

    def doubled(self, learner: LearnerSettings) -> LearnerSettings:
        """A learner with one map, with as many cells as two maps: twice as many along a side."""
        sides = self.robots[self.robot].workspace.position
        longest = sides.index(max(sides))
        cells = [(1 + (axis == longest)) * count for axis, count in enumerate(learner.supernet)]
        return learner.model_copy(update={"supernet": tuple(cells)})
