"""The paper's two learners, and the four changes that lead from one to the other."""

from typing import NamedTuple

IMPROVED, RITTER = "improved", "ritter"  # the learners of the paper


class Switch(NamedTuple):
    """One of the four changes that lead from Ritter's algorithm to the improved one."""

    key: str  # the key in a learner's settings
    # the values of the paper's two learners
    ritter: str
    improved: str
    without: str  # name of the improved system without this change
    added: str  # name of Ritter's algorithm with this change alone


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
