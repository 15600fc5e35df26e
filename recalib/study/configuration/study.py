"""A study as one typed value: every key of config.yaml, with its meaning, unit and range.

The shipped replication is one value of `Study`. Which trainings there are, and what they are
called, follows from it: see `recalib.study.plan.trainings`.
"""

import math
from collections.abc import Mapping as AnyMapping
from functools import cached_property
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field

from recalib.study.configuration.damages import Entry
from recalib.study.configuration.part import Part
from recalib.study.configuration.switches import IMPROVED, RITTER, SWITCHES
from recalib.study.configuration.units import (
    Amount,
    Angle,
    Checksum,
    Count,
    Distinct,
    Error,
    Fraction,
    Name,
    Number,
    Ordered,
    Range,
    Scale,
    Seed,
    SeriesName,
    Several,
    Side,
    Size,
    SomeDistinct,
    StudyName,
    Switch,
    Text,
    Times,
    Turn,
    Url,
)
from recalib.study.configuration.universes import Universes

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
        return round((math.prod(self.position) / math.prod(other.position)) ** (1 / 3), 4)


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
    iterations: Count
    """Iterations of a training."""


class Series(Part):
    """Robots with other assignments, or other amounts, of the paper's damage."""

    draws: Times
    """Assignments drawn."""
    scales: SomeDistinct[Scale]
    """Factors of all amounts."""


class Experiments(Part):
    """Which learners are trained on which scenarios."""

    scenarios: SomeDistinct[Text]
    """On the study's robot, or NAME-ROBOT."""
    learners: SomeDistinct[Name]
    """Trained on each of them: learners, or NAME_ITERATIONS."""
    beside: Distinct[Name]
    """More learners, trained on the study's own scenario alone."""
    switches: Switch
    """Whether to take each of the four changes from the improved system and add it to Ritter's."""
    ladder: dict[Name, Distinct[Count]]
    """Learners trained on the study's own scenario for several numbers of iterations."""
    evidence: Switch
    """Whether to judge and draw every claim of the paper, or those alone that trainings tell of."""
    robots: Distinct[Name]
    """Other robots for the study's own scenario."""
    ensemble: dict[Name, dict[SeriesName, Series]]
    """For each learner, robots with other assignments or amounts of the paper's damage."""
    draws_per_job: Times
    """Robots of a series that one job trains."""


class Benchmark(Part):
    """The comparison of all learners in robot moves."""

    scenarios: SomeDistinct[Text]
    """On the study's robot, or NAME-ROBOT."""
    learners: SomeDistinct[Name]
    """Today's learners, the paper's, or NAME_ITERATIONS."""
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
    """A real arm, whose recordings are no part of the project."""

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
    twin: Distinct[Name]
    """Those that choose their poses, and so learn on a twin."""
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
    """Seeds for the winner of each search: two at least, or there is no interval."""
    seeds_per_job: Times
    """Seeds that one job trains."""


class Ranges(Part):
    """Lowest and highest values of what is searched for."""

    initial_width: Ordered[Scale]
    """Of all neighbourhoods; the workspace is 2 wide."""
    final_width: Ordered[Fraction]
    """As a fraction of the initial one."""
    initial_rate: Ordered[Fraction]
    """In (0, 1]."""
    final_rate: Ordered[Fraction]
    """As a fraction of the initial one."""


class Budget(Part):
    """What every training may spend on the search for its widths and rates."""

    rounds: Annotated[int, Field(strict=True, ge=1, le=9)]
    """Of trials, each around the best of those before."""
    trials: Annotated[int, Field(strict=True, ge=1, le=1000)]
    """Trials of a round."""
    seeds: Times
    """Seeds over which a trial is averaged."""
    seed: Seed
    """Of trials and poses: each search has its own, and its poses are used nowhere else."""
    ranges: Ranges
    """Lowest and highest values."""
    score: Literal["worse", "geometric_mean"]
    """What is minimised: the larger or the geometric mean of both errors over `initial`."""
    initial: Published
    """The errors before learning, as the score has them."""


class SearchSettings(Budget):
    """The search for widths and rates."""

    short: Count
    """Trainings of up to so many iterations have `searches`."""
    searches: Several
    """Independent searches for a short training: two at least, or there is no interval."""
    searches_long: Several
    """Independent searches for a longer training."""
    iterations_per_job: Count
    """A job does as many searches as have so many iterations together, and one at least."""


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
    universes: Universes
    """Other readings of the paper, in which all is repeated."""

    @cached_property
    def every_learner(self) -> AnyMapping[str, LearnerSettings]:
        """Every learner by name: the configured ones, and those with one switch changed."""
        named = dict(self.learners)
        if IMPROVED in named and RITTER in named:
            improved, ritter = named[IMPROVED], named[RITTER]
            for switch in SWITCHES:
                value, other = getattr(improved, switch.key), getattr(ritter, switch.key)
                named.setdefault(switch.without, improved.model_copy(update={switch.key: other}))
                short = {switch.key: value, "iterations": improved.iterations}
                named.setdefault(switch.added, ritter.model_copy(update=short))
        return named
