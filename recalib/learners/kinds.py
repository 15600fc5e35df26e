"""The table of kinds of learners. Name a new kind here, and nowhere else.

Files of trained learners, the study's comparisons and its real arm all use this table.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from recalib.errors import UnknownName, check_name
from recalib.learners.corrections import GaussianProcessLearner, PolynomialLearner
from recalib.learners.geometric import GeometricLearner, HybridLearner
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.loop.interfaces import Savable

# The information that learners need.
POSES, KINEMATICS = "measured poses", "measured poses, nominal kinematics"


class Kind(NamedTuple):
    """A kind of learner that can be saved to files.

    Attributes:
        learner: its class.
        peers: settings for comparisons with the paper's learners, by the name of each comparison.
        needs: the information that it needs. Classes that know the kinematics also have the method
            `identify`: see `GeometricLearner.identify`.
    """

    learner: type[Savable]
    peers: Mapping[str, Mapping[str, Any]] = {}
    needs: str = POSES


KINDS = {
    "hierarchical": Kind(HierarchicalLearner),
    "polynomial": Kind(
        PolynomialLearner,
        {"affine": {"degree": 1}, "quadratic": {"degree": 2}},
    ),
    "gaussian_process": Kind(GaussianProcessLearner, {"Gaussian process": {}}),
    "geometric": Kind(GeometricLearner, {"geometric": {}}, KINEMATICS),
    "hybrid": Kind(HybridLearner, {"hybrid": {}}, KINEMATICS),
}


def kind_of(learner: object) -> str:
    """The kind of a learner. Raises UnknownName."""
    for name, kind in KINDS.items():
        if type(learner) is kind.learner:
            return name
    raise UnknownName("kind of learner to save", type(learner).__name__, KINDS)


def class_of(kind: str) -> type[Savable]:
    """The class of a kind. Raises UnknownName."""
    check_name("kind of learner", kind, KINDS)
    return KINDS[kind].learner
