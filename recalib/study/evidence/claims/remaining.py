"""Which share of the initial errors remains at the end: what several claims compare."""

from recalib.study.evidence.results import Evidence
from recalib.study.inference.intervals import Estimate, geometric
from recalib.study.inference.measured import KINDS, NONE


def remaining(evidence: Evidence, learner: str, kind: int, scenario: str | None = None) -> Estimate:
    """The share of the position error (kind 0) or of the orientation error (1) that remains."""
    first, last = (
        evidence.errors(learner, scenario, moment)[..., kind] for moment in ("first", "last")
    )
    return geometric(last / first, evidence.rng("left", learner, KINDS[kind]))


def both(evidence: Evidence, learner: str) -> dict[str, Estimate]:
    """The shares of both errors on the study's own scenario, but of one that was none at first."""
    first = evidence.errors(learner, moment="first").min(axis=(0, 1))
    return {
        f"{name} error": remaining(evidence, learner, kind)
        for kind, name in enumerate(KINDS)
        if first[kind] > NONE
    }
