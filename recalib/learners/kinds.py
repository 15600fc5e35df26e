"""The table of kinds of learners. Name a new kind here, and nowhere else.

Files of trained learners, the study's comparisons and its real arm all use this table.
"""

from collections.abc import Mapping
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any, NamedTuple

from recalib.errors import UnknownName, check_name

if TYPE_CHECKING:  # reading the table must not import the learners' dependencies
    from recalib.loop.interfaces import Savable

# The information that learners need.
POSES, KINEMATICS = "measured poses", "measured poses, nominal kinematics"


class Kind(NamedTuple):
    """A kind of learner that can be saved to files.

    Attributes:
        home: the module and name of its class.
        peers: settings for comparisons with the paper's learners, by the name of each comparison.
        needs: the information that it needs. Classes that know the kinematics also have the method
            `identify`: see `GeometricLearner.identify`.
    """

    home: str
    peers: Mapping[str, Mapping[str, Any]] = {}
    needs: str = POSES


KINDS = {
    "hierarchical": Kind("recalib.learners.hierarchical:HierarchicalLearner"),
    "polynomial": Kind(
        "recalib.learners.corrections:PolynomialLearner",
        {"affine": {"degree": 1}, "quadratic": {"degree": 2}},
    ),
    "gaussian_process": Kind(
        "recalib.learners.corrections:GaussianProcessLearner", {"Gaussian process": {}}
    ),
    "geometric": Kind("recalib.learners.geometric:GeometricLearner", {"geometric": {}}, KINEMATICS),
    "hybrid": Kind("recalib.learners.geometric:HybridLearner", {"hybrid": {}}, KINEMATICS),
}


def kind_of(learner: object) -> str:
    """The kind of a learner. Raises UnknownName."""
    learner_class = type(learner)
    for name, kind in KINDS.items():
        if kind.home == f"{learner_class.__module__}:{learner_class.__qualname__}":
            return name
    raise UnknownName("kind of learner to save", learner_class.__name__, KINDS)


def class_of(kind: str) -> "type[Savable]":
    """The class of a kind. Raises UnknownName."""
    check_name("kind of learner", kind, KINDS)
    return resolve_name(KINDS[kind].home)
