"""The paper's claims, in its order: a file for each, or for those that are measured alike.

What changed in them after a result had been seen stands in `workflow/deviations.yaml`.
"""

from collections.abc import Callable

from recalib.study.configuration.shipped import root_of
from recalib.study.configuration.study import Study
from recalib.study.evidence.claims import (
    changes,
    coarse_widths,
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
    single_valued,
    speed_up,
)
from recalib.study.evidence.needs import Request
from recalib.study.evidence.results import Evidence
from recalib.study.plan.trainings import Trainings

CLAIMS = (
    identity.CLAIM,
    single_valued.CLAIM,
    grid.CLAIM,
    ritter_slow.CLAIM,
    coupling.CLAIM,
    coupling.REASON,
    maps.LARGE,
    maps.SEPARATE,
    *maps.WIDTHS.values(),
    *maps.CELLS.values(),
    changes.THETA,
    reasons.THETA,
    changes.JACOBIAN,
    reasons.JACOBIAN,
    coarse_widths.CLAIM,
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


def judging(request: Callable[[], Request]) -> dict[str, Evidence]:
    """What the claims may read, each by itself, by their ids.

    These are the claims of which the study's trainings tell, or all. What was measured of the
    shipped study alone judges no claim of another one.
    """
    found = {}
    for claim in CLAIMS:
        ask = request().read(claim.all_needs)
        if (ask.study.experiments.evidence or ask.trained) and not ask.foreign:
            found[claim.id] = ask.evidence
    return found


def judge(claims: dict[str, Evidence]) -> list[dict]:
    """Each claim with what was measured and its verdict, as the contract of claims.json asks."""
    return [claim.judge(claims[claim.id]) for claim in CLAIMS if claim.id in claims]


def missing(study: Study) -> list[str]:
    """The keys that would have to say more for all claims to be judged, such as `learners: x`."""
    root = root_of(study.name)
    ask = Request(study, Trainings(study), root, lambda name: f"{root}/search/{name}.csv")
    return ask.read(" ".join(claim.all_needs for claim in CLAIMS)).lacking
