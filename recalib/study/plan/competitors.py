"""The learners that are compared: what each needs to know, its constructor, label and colour.

The paper's are made from their settings in the configuration
(`recalib.study.experiments.settings`). They, and learners that are not listed here, make two moves
an iteration; today's make one.
"""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, NamedTuple

from recalib.errors import UnknownName

# Whoever only asks for names need not wait for what builds and moves arms.
if TYPE_CHECKING:
    from recalib.loop.interfaces import Learner
    from recalib.nominal.controller import Controller

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
    """

    label: str
    color: str
    marker: str
    needs: str = TWO_MOVES


COMPETITORS: Mapping[str, Competitor] = {
    "improved": Competitor("improved", "#0072B2", "o"),
    "ritter": Competitor("Ritter", "#D55E00", "P"),
    "uncorrected": Competitor("uncorrected", "0.5", "", "nothing"),
    "affine": Competitor("affine", "#CC79A7", "v", POSES),
    "quadratic": Competitor("quadratic", "#E69F00", "^", POSES),
    "gaussian_process": Competitor("Gaussian process", "#009E73", "D", POSES),
    "geometric": Competitor("geometric", "#56B4E9", "s", KINEMATICS),
    "hybrid": Competitor("hybrid", "#000000", "*", KINEMATICS),
}
PEERS = [name for name, its in COMPETITORS.items() if its.needs != TWO_MOVES]  # today's learners


def make_peer(name: str, runs: int, controller: "Controller") -> "Learner":
    """The peer of this name, which has learned nothing yet. Raises UnknownName.

    Args:
        runs: so many at the same time.
        controller: the nominal one.
    """
    # Imported here: jobs without such a learner need not wait for SciPy.
    from recalib.learners.gaussian_process import GaussianProcessLearner
    from recalib.learners.geometric import GeometricLearner
    from recalib.learners.hybrid import HybridLearner
    from recalib.learners.polynomial import PolynomialLearner
    from recalib.learners.uncorrected import UncorrectedLearner

    makes: Mapping[str, Callable[[], Learner]] = {
        "uncorrected": UncorrectedLearner,
        "affine": lambda: PolynomialLearner(runs=runs, degree=1),
        "quadratic": lambda: PolynomialLearner(runs=runs, degree=2),
        "gaussian_process": lambda: GaussianProcessLearner(runs=runs),
        "geometric": lambda: GeometricLearner(controller, runs=runs),
        "hybrid": lambda: HybridLearner(controller, runs=runs),
    }
    if name not in makes:
        raise UnknownName("peer", name, PEERS)
    return makes[name]()


def needs_of(name: str) -> str:
    """What a learner needs to know."""
    return COMPETITORS[name].needs if name in COMPETITORS else TWO_MOVES


def label_of(name: str) -> str:
    """What a learner is called."""
    return COMPETITORS[name].label if name in COMPETITORS else name.replace("_", " ")
