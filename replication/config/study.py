"""The configuration of a study: every key of config.yaml, with its meaning, unit and range.

The shipped replication is one value of `Study`. `replication.training.plan` derives all trainings
from it.
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
    """Lengths along the base's x, y and z."""
    orientation: tuple[Range, Range, Range]
    """Ranges of roll, pitch and yaw, or of the components of rotation vectors."""
    coordinates: Literal["roll_pitch_yaw", "rotation_vector"] = "roll_pitch_yaw"
    """Coordinates of orientations."""

    def scale_to(self, other: Self) -> float:
        """Size relative to another workspace: the cube root of the ratio of volumes."""
        return round(math.cbrt(math.prod(self.position) / math.prod(other.position)), 4)


class RobotSettings(Part):
    """A nominal robot."""

    urdf: Text
    """File name of a URDF of example-robot-data, or a path from the project's folder."""
    tool: Text
    """Link whose frame is the pose."""
    beyond: Amount = 0.0
    """Length of a rigid tool that extends outwards from this link, along the last joint's axis."""
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
    """Largest accepted condition number of the Jacobian in the workspace."""


class Published(Part):
    """Initial errors in the paper."""

    position_error_cm: Error
    """Position error in centimetres."""
    orientation_error_deg: Error
    """Orientation error in degrees."""


class PaperDamage(Part):
    """The damage of section 7, whose links, encoders and signs are not published."""

    shorten: Annotated[tuple[Size, ...], Filled]
    """Lengths taken off links, one for each damaged link."""
    shift: Annotated[tuple[Annotated[Turn, Field(gt=0)], ...], Filled]
    """Angles by which encoders are shifted, in either direction, one for each damaged encoder."""
    published: Published
    """Initial errors in the paper."""
    poses: Times
    """Random poses over which initial errors are averaged."""


CellCount = Annotated[int, Field(strict=True, ge=1, le=20)]
Grid = tuple[CellCount, CellCount, CellCount]


class LearnerSettings(Part):
    """A learner of the paper: four switches, and the sizes of its nets."""

    maps: Literal["single", "separate"]
    """One map for the whole command, or one for position and one for orientation (section 4)."""
    theta: Literal["values", "increments"]
    """Whether values or increments of theta are propagated (section 5)."""
    jacobian: Literal["values", "increments"]
    """Whether values or increments of Jacobians are propagated (section 5)."""
    schedule: Literal["exponential", "equal_visits"]
    """Decay of widths and rate (section 6)."""
    supernet: Grid
    """Cells along x, y and z."""
    subnet: Grid
    """Cells along roll, pitch and yaw."""


class Ensemble(Part):
    """Robots with other assignments and other amounts of the paper's damage."""

    draws: Times
    """Number of random assignments."""
    scales: SomeDistinct[Scale]
    """Factors that multiply all amounts."""


Lengths = SomeDistinct[Count]


class Experiments(Part):
    """The learners to train, on which scenarios, and for how many iterations."""

    scenarios: SomeDistinct[Name]
    """Scenarios on the study's robot."""
    learners: Annotated[dict[Name, Lengths], Filled]
    """Numbers of iterations in each of these scenarios, by learner."""
    robots: Distinct[Name]
    """Other robots on which the same learners are trained, in the study's main scenario."""
    own: dict[Name, Distinct[Count]]
    """Additional numbers of iterations in the study's main scenario, by learner."""
    iterations: Count
    """Iterations of Figure 1, and of the improved system with a switch changed."""
    switches: Switch
    """Whether to remove each of four changes from the improved system and add it to Ritter's."""
    evidence: Switch
    """Whether to judge and plot all claims of the paper, or only claims about trainings."""
    ensemble: Ensemble
    """Robots with other assignments and amounts of the paper's damage."""


class Benchmark(Part):
    """The comparison of all learners in robot moves."""

    scenarios: SomeDistinct[Name]
    """Scenarios on the study's robot."""
    learners: SomeDistinct[Name]
    """Today's learners."""
    papers: dict[Name, Count]
    """The paper's learners, each with its number of iterations."""
    seeds: Several
    """Number of seeds of each learner on each scenario."""
    moves: SomeDistinct[Times]
    """Numbers of moves after which to measure errors."""
    longer: Distinct[Count]
    """More numbers of moves, for longer trainings."""
    thresholds: SomeDistinct[Error]
    """Errors to reach, in cm and degrees; pages report the smallest."""


class Source(Part):
    """A recording of the real arm."""

    file: Text | None
    """Path of a copy on this machine."""
    url: Url
    """Public address."""
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
    """Recordings of the arm."""
    description: Text
    """A file of the project that describes the recordings: units, frames, columns."""
    published: PublishedReal
    """Errors that were published with the recordings."""
    learners: SomeDistinct[Name]
    """Learners that can learn from recorded poses."""
    twin: dict[Name, Count]
    """The paper's learners, which choose their poses and so need a twin, with their iterations."""
    poses: SomeDistinct[Several]
    """Numbers of poses to learn from."""
    subsets: Several
    """Number of random subsets for each number of poses."""


class Mapping(Part):
    """Measurements of the true mapping, without a learner."""

    poses: Times
    """Number of random poses for Jacobians of the mapping."""
    balls: Times
    """Number of balls for the integrals of section 5."""
    points: Times
    """Number of random points in a ball."""
    radius: Fraction
    """Radius of a ball, in workspace coordinates."""
    scales: SomeDistinct[Scale]
    """Factors that multiply the damage."""


class Measuring(Part):
    """Test poses of trainings, and when to measure errors on them."""

    tests: Times
    """Number of random poses for a measurement."""
    measure_every: Count
    """Iterations between two measurements."""
    measure_evenly: Count
    """Iterations; longer trainings are measured on a logarithmic grid."""
    measurements: Several
    """Number of points of this grid."""

    def during(self, iterations: int) -> list[int]:
        """The iterations after which to measure, in a training of a given length."""
        if iterations <= self.measure_evenly:
            return sorted({*range(0, iterations, self.measure_every), iterations})
        grid = np.geomspace(1, iterations, self.measurements).round().astype(int)
        return sorted({0, *grid.tolist()})


class TrainingSettings(Measuring):
    """How trainings are run and measured."""

    seeds: Several
    """Number of seeds of each training."""


class SearchSettings(Part):
    """The search for widths and rates."""

    searches: Several
    """Number of independent searches for each training, with their own seeds and poses."""
    seed: Seed
    """Seed of searches and their poses, which are not used elsewhere."""
    ranges: Ranges
    """Ranges of settings."""
    trials: Times
    """Number of settings that a search tries at first."""
    runs: Times
    """Number of runs over which a trial is averaged, each with its own poses."""
    long: Count
    """Iterations; the trials of longer trainings have `long_runs` runs instead."""
    long_runs: Times
    """Number of runs over which a trial of a long training is averaged."""
    near: Count
    """Iterations; the search for a longer training starts at the winner of the next shorter one."""
    near_trials: Times
    """Number of settings that such a search tries at first."""
    within: Fraction
    """Searches have converged if their winners differ by less than this share, on fresh poses."""
    fresh: Several
    """Number of runs on fresh poses."""
    doublings: Annotated[int, Field(strict=True, ge=0, le=9)]
    """How often all searches may restart with twice as many trials."""


class Study(Part):
    """Robot, damage, learners, settings, budgets and seeds: together they determine findings."""

    name: StudyName
    """`replication` is the shipped study; results of others are in results/studies/NAME."""
    seed: Seed
    """Seed of the whole study."""
    robot: Name
    """The study's robot, a key of robots."""
    scenario: Name
    """The study's main scenario, the paper's damage: for Figure 1, ladders and searches."""
    settings: Literal["shipped", "own"]
    """Widths and rates from the shipped study, if it has them, or from this study's own search."""
    expected: Text | None
    """File with the expected bands of final errors; null: no check."""
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
    """The learners to train, and on which scenarios."""
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
    """The reference study, and setups with other decisions on what the paper leaves open."""

    @cached_property
    def every_learner(self) -> AnyMapping[str, LearnerSettings]:
        """Every learner by name: configured learners, and variants with one switch changed."""
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
        """A one-map learner with the cells of two maps: twice as many along the longest side."""
        sides = self.robots[self.robot].workspace.position
        longest = sides.index(max(sides))
        cells = [(1 + (axis == longest)) * count for axis, count in enumerate(learner.supernet)]
        return learner.model_copy(update={"supernet": tuple(cells)})
