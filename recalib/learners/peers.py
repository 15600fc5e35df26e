"""The learners of today that the paper's maps are compared with, by name.

Each makes one move an iteration.
"""

from typing import TYPE_CHECKING

from recalib.errors import UnknownName

# Whoever only asks for names need not wait for what builds and moves arms.
if TYPE_CHECKING:
    from recalib.interfaces import Learner
    from recalib.nominal.controller import Controller

NEEDS = {
    "uncorrected": "nothing",
    "affine": "measured poses",
    "quadratic": "measured poses",
    "gaussian_process": "measured poses",
    "geometric": "measured poses, nominal kinematics",
    "hybrid": "measured poses, nominal kinematics",
}


def build(name: str, runs: int, controller: "Controller") -> "Learner":
    """The peer of this name, which has learned nothing yet. Raises UnknownName."""
    # Imported where they are used: jobs without a peer need not wait for scikit-learn.
    match name:
        case "uncorrected":
            from recalib.learners.uncorrected import UncorrectedLearner

            return UncorrectedLearner()
        case "affine" | "quadratic":
            from recalib.learners.polynomial import PolynomialLearner

            return PolynomialLearner(runs, degree=1 if name == "affine" else 2)
        case "gaussian_process":
            from recalib.learners.gaussian_process import GaussianProcessLearner

            return GaussianProcessLearner(runs)
        case "geometric":
            from recalib.learners.geometric import GeometricLearner

            return GeometricLearner(runs, controller)
        case "hybrid":
            from recalib.learners.hybrid import HybridLearner

            return HybridLearner(runs, controller)
    raise UnknownName("peer", name, NEEDS)
