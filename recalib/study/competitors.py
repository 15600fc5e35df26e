"""The learners that are compared, a home for each: what it needs, how it is made, how it looks.

The paper's are made of their settings in the configuration (`recalib.study.experiments.settings`);
they, and learners of nobody's foreseeing, make two moves an iteration, today's one.
"""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, NamedTuple

from recalib.errors import UnknownName

# Whoever only asks for names need not wait for what builds and moves arms.
if TYPE_CHECKING:
    from recalib.interfaces import Learner
    from recalib.nominal.controller import Controller

Make = Callable[[int, "Controller"], "Learner"]
MOVES = 2  # of an iteration of the paper's learners
POSES, KINEMATICS = "measured poses", "measured poses, nominal kinematics"
TWO_MOVES = f"{POSES}, two moves for each"


class Competitor(NamedTuple):
    """A learner that is compared.

    Attributes:
        label: what it is called.
        color: of Okabe and Ito's palette, which the colour-blind can tell apart.
        marker: for black and white; empty for none.
        needs: what it needs to know.
        make: from the number of runs and the nominal controller, the learner that has learned
            nothing yet; None for the paper's.
    """

    label: str
    color: str
    marker: str
    needs: str = TWO_MOVES
    make: Make | None = None


# Imported where they are used: jobs without such a learner need not wait for SciPy.
def _uncorrected(runs: int, controller: "Controller") -> "Learner":
    from recalib.learners.uncorrected import UncorrectedLearner

    return UncorrectedLearner()


def _affine(runs: int, controller: "Controller") -> "Learner":
    from recalib.learners.polynomial import PolynomialLearner

    return PolynomialLearner(runs=runs, degree=1)


def _quadratic(runs: int, controller: "Controller") -> "Learner":
    from recalib.learners.polynomial import PolynomialLearner

    return PolynomialLearner(runs=runs, degree=2)


def _gaussian_process(runs: int, controller: "Controller") -> "Learner":
    from recalib.learners.gaussian_process import GaussianProcessLearner

    return GaussianProcessLearner(runs=runs)


def _geometric(runs: int, controller: "Controller") -> "Learner":
    from recalib.learners.geometric import GeometricLearner

    return GeometricLearner(controller, runs=runs)


def _hybrid(runs: int, controller: "Controller") -> "Learner":
    from recalib.learners.hybrid import HybridLearner

    return HybridLearner(controller, runs=runs)


COMPETITORS: Mapping[str, Competitor] = {
    "improved": Competitor("improved", "#0072B2", "o"),
    "ritter": Competitor("Ritter", "#D55E00", "P"),
    "uncorrected": Competitor("uncorrected", "0.5", "", "nothing", _uncorrected),
    "affine": Competitor("affine", "#CC79A7", "v", POSES, _affine),
    "quadratic": Competitor("quadratic", "#E69F00", "^", POSES, _quadratic),
    "gaussian_process": Competitor("Gaussian process", "#009E73", "D", POSES, _gaussian_process),
    "geometric": Competitor("geometric", "#56B4E9", "s", KINEMATICS, _geometric),
    "hybrid": Competitor("hybrid", "#000000", "*", KINEMATICS, _hybrid),
}
PEERS = [name for name, competitor in COMPETITORS.items() if competitor.make]  # today's learners


def make_peer(name: str, runs: int, controller: "Controller") -> "Learner":
    """The peer of this name, which has learned nothing yet. Raises UnknownName."""
    if name not in PEERS:
        raise UnknownName("peer", name, PEERS)
    return COMPETITORS[name].make(runs, controller)


def needs_of(name: str) -> str:
    """What a learner needs to know."""
    return COMPETITORS[name].needs if name in COMPETITORS else TWO_MOVES


def label_of(name: str) -> str:
    """What a learner is called."""
    return COMPETITORS[name].label if name in COMPETITORS else name.replace("_", " ")
