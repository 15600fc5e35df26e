"""Section 7: how the parameters were found."""

import numpy as np

from recalib.study.evidence.claims.claim import Claim, Finding, Limit, above
from recalib.study.statistics import estimate


def needs(ask):
    for role in ("improved", "ritter"):
        ask.sample(ask.fact(role))
    ask.fact("seed")


def measure(evidence, limits):
    shares = {}
    for label, role in (("improved", "improved"), ("Ritter", "ritter")):
        within = []
        for _, trials in evidence.sample(evidence.fact(role)).groupby("search"):
            first = trials[trials["round"] == 1]
            within.append(np.mean(first["score"] <= limits["factor"] * trials["score"].min()))
        # a search's share has the luck of its trials in it already
        shares[label] = estimate(np.array(within)[:, None], evidence.rng("rough", label))
    return Finding.of(above(shares["improved"], limits["share"]), shares)


CLAIM = Claim(
    id="rough-search",
    section="7",
    statement="A very rough search is enough to find the parameters.",
    short="A very rough search is enough: {} of all trials come near",
    published="a very rough search",
    limits={"share": Limit(0.1), "factor": Limit(2.0)},
    criterion="More than a {share:word} of the first round's trials, spread over all ranges, come"
    " within {factor:word} the best of their search (whole interval, improved system).",
    reason="Then twenty blind trials find such a setting with a probability of 88 %.",
    needs=needs,
    measure=measure,
    figures=("figure6",),
)
