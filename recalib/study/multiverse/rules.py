"""Learning as the conventions of a universe have it."""

from dataclasses import replace

from recalib.learners.rules import Rules
from recalib.study.experiments.settings import rules_of
from recalib.study.multiverse.universe import Universe


def rules_in(universe: Universe, learner: str) -> Rules:
    """The rules of one of its learners; how its rate falls goes with how its widths fall."""
    rules, conventions = rules_of(universe.learners[learner]), universe.conventions
    return replace(
        rules,
        **conventions.model_dump(),
        rate=universe.rate_of_visits if rules.equal_visits else universe.ritters_rate,
    )
