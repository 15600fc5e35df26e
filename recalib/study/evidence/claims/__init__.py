"""The paper's claims, in its order: a file for each, or for those that are measured alike.

What changed in them after a result had been seen stands in `workflow/deviations.yaml`.
"""

from collections.abc import Callable

from recalib.study.configuration.part import Frozen
from recalib.study.configuration.study import Study
from recalib.study.evidence.claims import (
    changes,
    controller_kept,
    coupling,
    expected_learning,
    figure_1,
    grid,
    identity,
    initial_error,
    local_units,
    maps,
    reasons,
    rigid,
    ritter_slow,
    rough_search,
    speed_up,
)
from recalib.study.evidence.needs import Needs, Request
from recalib.study.evidence.results import Evidence
from recalib.study.layout import Layout, root_of
from recalib.study.trainings import Trainings

CLAIMS = (
    identity.CLAIM,
    grid.CLAIM,
    ritter_slow.CLAIM,
    coupling.CLAIM,
    maps.LARGE,
    maps.SEPARATE,
    *maps.WIDTHS.values(),
    *maps.CELLS.values(),
    changes.THETA,
    reasons.THETA,
    changes.JACOBIAN,
    reasons.JACOBIAN,
    expected_learning.CLAIM,
    changes.SCHEDULE,
    rigid.CLAIM,
    initial_error.CLAIM,
    figure_1.CLAIM,
    speed_up.CLAIM,
    rough_search.CLAIM,
    controller_kept.CLAIM,
    local_units.CLAIM,
)


class Judging(Frozen):
    """What the claims may read, by their ids."""

    claims: dict[str, Needs]

    @property
    def inputs(self) -> list[str]:
        """All files."""
        return list(dict.fromkeys(path for needs in self.claims.values() for path in needs.inputs))


def judging(request: Callable[[], Request]) -> Judging:
    """What the claims need, each by itself: those of which the study's trainings tell, or all.

    What was measured of the shipped study alone judges no claim of another one.
    """
    needs = {}
    for claim in CLAIMS:
        ask = request()
        claim.ask(ask)
        if (ask.study.experiments.evidence or ask.trained) and not ask.foreign:
            needs[claim.id] = ask.needs
    return Judging(claims=needs)


def judge(job: Judging) -> list[dict]:
    """Each claim with what was measured and its verdict, as the contract of claims.json asks."""
    judged = (claim for claim in CLAIMS if claim.id in job.claims)
    return [claim.judge(Evidence(job.claims[claim.id])) for claim in judged]


def missing(study: Study) -> list[str]:
    """The keys that would have to say more for all claims to be judged, such as `learners: x`."""
    layout, trainings = Layout(root_of(study.name)), Trainings(study)
    ask = Request(study, trainings, layout, layout.searched)
    for claim in CLAIMS:
        claim.ask(ask)
    return ask.lacking
