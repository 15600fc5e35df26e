"""Sections 1 and 7: how many times as fast."""

import numpy as np

from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim, Finding, Limit
from recalib.study.evidence.factor import CELLS, PUBLISHED, leading, verdict
from recalib.study.evidence.verdicts import Comparison

LONG = Limit(50.0)  # more than 10,000 iterations over 200


def measure(evidence, limits):
    own, found, ends, notes = evidence.facts["iterations"], {}, {}, []
    for learner, cells in CELLS.items():
        rungs, label = evidence.ladder(learner), f"factor, as many cells as {cells}"
        found[label] = leading(evidence, learner)
        ends[label] = min(rungs) / own, max(rungs) / own
        notes.append(f"with as many cells as {cells}, {_needed(found[label], own, ends[label])}")
    judged = verdict(next(iter(found.values())))
    return Finding(found, judged, note=f"Ritter's, {' and, '.join(notes)}.", ends=ends)


def _needed(factor, own, ends):
    if np.isnan(factor.mean):
        return f"needs at most {own * ends[0]:,.0f} iterations, the first rung"
    if np.isinf(factor.mean):
        return f"does not get there in {own * ends[1]:,.0f} iterations, the last rung"
    return f"needs {own * factor.mean:,.0f} iterations for the errors of the improved system"


CLAIM = Claim(
    id="speed-up",
    section="1, 7",
    quotation="two hierarchical networks which, as a whole, had the same number of neurons as the"
    " Ritter et al.'s model [...] required more than 10,000 iterations",
    statement="Ritter's needs about 70 times as many iterations for the same errors.",
    short="{number} times",
    published=f"a factor of {PUBLISHED}, near to 2 orders of magnitude",
    limits={"long": LONG},
    criterion=f"{PUBLISHED} lies in the interval of the factor at the errors that the improved"
    " system has after {iterations} iterations, and the interval's ends differ by a factor of 4 at"
    " most."
    " Ritter's net has as many cells as both maps together; both are tuned for each number of"
    " iterations with the same effort.",
    reason='The paper counts neurons so, and equal effort is fair. It also says "near to 2 orders'
    ' of magnitude". The mean over the setups holds both numbers of cells and is compared with'
    f" {LONG:g}: more than 10,000 iterations over 200.",
    needs="runs/{scenario}/{ladder}.parquet seed iterations",
    measure=measure,
    across={
        "both systems": Across(
            "factor",
            "Ritter's iterations / improved",
            Comparison(LONG, below=False),
            table="horizon",
        )
    },
    figures=("figure9",),
)
