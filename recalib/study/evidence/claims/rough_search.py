"""Section 7: how the parameters were found."""

from recalib.study.evidence.claims.claim import Claim, Finding, Limit
from recalib.study.statistics import share


def needs(ask):
    for role in ("improved", "ritter"):
        ask.sample(ask.fact(role))
    ask.fact("seed")


def measure(evidence, limits):
    from recalib.study.experiments.search import score

    shares = {}
    for label, role in (("improved", "improved"), ("Ritter", "ritter")):
        trials = evidence.sample(evidence.fact(role))
        first = trials[trials["round"] == 1]
        within = score(first) <= limits["factor"] * score(trials).min()
        shares[label] = share(within, evidence.rng("rough", label))
    return Finding.of(shares["improved"].low >= limits["share"], shares)


CLAIM = Claim(
    id="rough-search",
    section="7",
    statement="A very rough search is enough to find the parameters.",
    published="a very rough search",
    limits={"share": Limit(0.1), "factor": Limit(2.0)},
    criterion="At least a {share:word} of the first round's trials, spread over all ranges, come"
    " within {factor:word} the best (lower end).",
    reason="Then twenty blind trials find such a setting with a probability of 88 %.",
    needs=needs,
    measure=measure,
    figures=("figure6",),
    interpretation="The share of good trials is about the one asked for, but the first round has"
    " too few of them to show it with confidence.",
)
