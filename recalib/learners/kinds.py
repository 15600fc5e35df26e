"""The kinds of learner that can be saved to files. A new kind is named here, and nowhere else."""

from importlib import import_module
from typing import TYPE_CHECKING

from recalib.errors import UnknownName

if TYPE_CHECKING:  # whoever only asks for a kind need not wait for what a learner needs
    from recalib.loop.interfaces import Savable

# Where the class of each is at home.
KINDS = {
    "hierarchical": "recalib.learners.hierarchical.HierarchicalLearner",
    "polynomial": "recalib.learners.polynomial.PolynomialLearner",
    "gaussian_process": "recalib.learners.gaussian_process.GaussianProcessLearner",
    "geometric": "recalib.learners.geometric.GeometricLearner",
    "hybrid": "recalib.learners.hybrid.HybridLearner",
}


def kind_of(learner: object) -> str:
    """The kind of a learner. Raises UnknownName."""
    its = type(learner)
    for kind, home in KINDS.items():
        if home == f"{its.__module__}.{its.__qualname__}":
            return kind
    raise UnknownName("kind of learner to save", its.__name__, KINDS)


def class_of(kind: str) -> "type[Savable]":
    """The class of a kind. Raises UnknownName."""
    if kind not in KINDS:
        raise UnknownName("kind of learner", kind, KINDS)
    module, _, name = KINDS[kind].rpartition(".")
    found: type[Savable] = getattr(import_module(module), name)
    return found
