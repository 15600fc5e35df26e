"""Section 4: which widths each map wants."""

import numpy as np

from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim, Finding, Limit, above, below, every
from recalib.study.measured import KINDS
from recalib.study.statistics import geometric


def needs(ask):
    ask.sample(ask.fact("improved"))
    for fact in ("iterations", "seed"):
        ask.fact(fact)


def measure(evidence, limits):
    # later rounds surround one trial, and are not independent
    trials = evidence.sample(evidence.fact("improved")).query("round == 1")
    searches = [own for _, own in trials.groupby("search")]
    count = int(np.ceil(limits["best"] * len(searches[0])))
    best = [own.nsmallest(count, "score") for own in searches]
    estimates = {
        f"{name} map, g_k over g_kl": geometric(
            np.array([own[f"{name}/g_k"] / own[f"{name}/g_kl"] for own in best]),
            evidence.rng("widths", name),
        )
        for name in KINDS
    }
    position, orientation = estimates.values()
    holds = every([below(position, limits["ratio"]), above(orientation, limits["ratio"])])
    note = f"{count} best of {len(searches[0])} independent trials in each of {len(best)} searches."
    return Finding.of(holds, estimates, note)


CLAIM = Claim(
    id="width-order",
    section="4",
    statement="The position map wants a narrow g_k and a wide g_kl, the orientation map the"
    " reverse.",
    short="Position commands want narrow g_k and wide g_kl, orientation the reverse: ratio {}",
    published="no number",
    limits={"ratio": Limit(1.0), "best": Limit(0.1)},
    criterion="Among the best {best:word} of the first round's trials of each search for the"
    " improved system at {iterations} iterations, final g_k over g_kl is below {ratio} for the"
    " position map and above {ratio} for the orientation map (whole intervals).",
    reason="The first round chooses all four widths independently; what its best trials share is"
    " what the maps want. (A first version took the trials of all rounds; later rounds surround one"
    " trial and are no independent sample.)",
    needs=needs,
    measure=measure,
    across={"": Across("width_order", "narrow / wide, the worse map")},
    figures=("figure6",),
)
