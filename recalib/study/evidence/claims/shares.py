"""How much of an initial error is left at the end: what several claims compare."""

from recalib.study.evidence.results import Evidence
from recalib.study.measured import KINDS
from recalib.study.statistics import Estimate, geometric


def left(evidence: Evidence, learner: str, kind: int, scenario: str | None = None) -> Estimate:
    """The share that is left of the position error (kind 0) or of the orientation error (1)."""
    first, last = (
        evidence.errors(learner, scenario, moment)[..., kind] for moment in ("first", "last")
    )
    return geometric(last / first, evidence.rng("left", learner, KINDS[kind]))


def both_left(evidence: Evidence, learner: str) -> dict[str, Estimate]:
    """What is left of both errors on the study's own scenario."""
    return {f"{name} left": left(evidence, learner, kind) for kind, name in enumerate(KINDS)}
