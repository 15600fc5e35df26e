"""What each kind of job needs, as one typed value: made from the study once, and handed over whole.

Beside its inputs, a script sees nothing else. It travels as JSON, because of all types Snakemake
tracks only the built-in ones: a change of any other would not run a job again.
"""

from recalib.study.configuration.damages import Entry
from recalib.study.configuration.part import Frozen
from recalib.study.configuration.study import (
    Amounts,
    Budget,
    Controller,
    Learner,
    Mapping,
    PaperDamage,
    Robot,
    Series,
    Source,
)
from recalib.study.configuration.universes import Universes


class Nominal(Frozen):
    """The robot as its controller believes in it."""

    name: str
    robot: Robot
    controller: Controller
    urdf_sha256: str
    """Digest of the file that `robot.urdf` means: results follow from what stands in it."""


class Assignments(Frozen):
    """Every assignment of the paper's damage to a robot."""

    nominal: Nominal
    damage: PaperDamage
    seed: int


class Design(Frozen):
    """The design of the multiverse.

    The robots by name, the study's own first; the damage, and by what the whole robot is moved, are
    those of the first.
    """

    plan: Universes
    robots: tuple[Nominal, ...]
    damage: PaperDamage
    moved: tuple[Entry, ...]


class Efforts(Frozen):
    """The winners of full and of rough searches for a training, so many seeds for each.

    A rough search has `rough` trials.
    """

    learner: Learner
    rough: int
    seeds: int
    tests: int
    seed: int


class Scenario(Frozen):
    """A damage to be resolved, and its initial errors."""

    name: str
    nominal: Nominal
    damages: tuple[Entry, ...]
    poses: int
    seed: int


class Measuring(Frozen):
    """On how many poses a training is measured, and when."""

    tests: int
    every: int
    evenly: int
    measurements: int


class Training(Frozen):
    """Some seeds of a training: from `first` to before `last`, so many for each search."""

    scenario: str
    learner: Learner
    seeds: int
    first: int
    last: int
    measuring: Measuring
    throughout: bool
    seed: int


class Searches(Frozen):
    """Some of the searches for a training: from `first` to before `last`."""

    training: str
    learner: Learner
    budget: Budget
    first: int
    last: int
    tests: int


class Sample(Frozen):
    """All trials of the searches for a training, and what was searched for, on what."""

    learner: Learner
    searches: int
    budget: Budget
    robot: str
    scenario: str


class Draws(Frozen):
    """Some robots of a series of other damages: from `first` to before `last`."""

    nominal: Nominal
    damage: Amounts
    series: str
    plan: Series
    first: int
    last: int
    learner: Learner
    tests: int
    seed: int


class TrueMapping(Frozen):
    """Measurements of the true mapping, and of the cells that cover it."""

    plan: Mapping
    seed: int


class Visits(Frozen):
    """The Monte Carlo of the expected learning."""

    seed: int


class Replay(Frozen):
    """A training by a robot, and by the table of what the robot did."""

    learner: Learner
    seed: int


class Benchmark(Frozen):
    """A learner on scenarios that share a job: a learner of the paper, or today's of this name."""

    name: str
    learner: Learner | None
    scenarios: tuple[str, ...]
    seeds: int
    moves: tuple[int, ...]
    longer: tuple[int, ...]
    tests: int
    seed: int


class RealData(Frozen):
    """A recording of the real arm to be fetched."""

    source: Source


class RealRun(Frozen):
    """A learner on random subsets of the recorded poses."""

    nominal: Nominal
    learner: str
    poses: tuple[int, ...]
    subsets: int
    seed: int


class RealTwin(Frozen):
    """A learner of the paper on the twin of the real arm."""

    nominal: Nominal
    name: str
    learner: Learner
    poses: tuple[int, ...]
    subsets: int
    tests: int
    seed: int


class Summary(Frozen):
    """The final errors of trainings, each a scenario and a learner, in this order."""

    trainings: tuple[tuple[str, str], ...]
    seed: int


class BenchmarkTable(Frozen):
    """The errors of the benchmark, and the moves to each threshold."""

    scenarios: tuple[str, ...]
    learners: tuple[str, ...]
    thresholds: tuple[float, ...]
    seed: int


class RealTable(Frozen):
    """The errors on the real arm."""

    seed: int


class Recording(Frozen):
    """Learners that are recorded side by side, by name: today's have no settings, and few moves."""

    scenario: str
    learners: dict[str, Learner | None]
    moves: int
    measuring: Measuring
    seed: int
    published: dict[str, float]
    meshes_sha256: str
    """Digest of the meshes that are drawn."""

    def papers(self) -> list[str]:
        """Those of the paper, whose trainings are experiments of the study."""
        return [name for name, learner in self.learners.items() if learner]


class Speed(Frozen):
    """The learners whose speed is measured, by name."""

    learners: dict[str, Learner]
