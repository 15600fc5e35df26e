"""The paper's two learners, and the four changes that lead from one to the other."""

from typing import NamedTuple

IMPROVED, RITTER = "improved", "ritter"  # the learners of the paper


class Switch(NamedTuple):
    """One of the four changes that lead from Ritter's algorithm to the improved one.

    Attributes:
        key: of a learner's settings.
        ritter, improved: what each of the paper's learners has there.
        without: the improved system with this change taken away.
        added: Ritter's algorithm with this change alone.
    """

    key: str
    ritter: str
    improved: str
    without: str
    added: str


SWITCHES = (
    Switch("maps", "single", "separate", "improved_single_map", "ritter_separate_maps"),
    Switch("theta", "values", "increments", "improved_theta_values", "ritter_theta_increments"),
    Switch(
        "jacobian", "values", "increments", "improved_jacobian_values", "ritter_jacobian_increments"
    ),
    Switch(
        "schedule", "exponential", "equal_visits", "improved_exponential", "ritter_equal_visits"
    ),
)
