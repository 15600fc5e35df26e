"""What the README says of the results: the three that matter, and a verdict on every claim."""

from collections.abc import Mapping

from recalib.study.evidence.claims import CLAIMS
from recalib.study.evidence.factor import PUBLISHED
from recalib.study.evidence.needs import Request
from recalib.study.evidence.results import Evidence
from recalib.study.evidence.words import n, one, typical_errors


def needs(ask: Request) -> None:
    """What the page reads."""
    ask.summary()
    ask.claims()
    for fact in ("improved", "scenario"):
        ask.fact(fact)


def _in_a_line(claims: Mapping[str, Mapping]) -> dict[str, str]:
    """Each claim in short with the first number measured for it, by its id."""
    first = {name: one(claim, next(iter(claim["measured"]))) for name, claim in claims.items()}
    return {claim.id: claim.short.format(first[claim.id]) for claim in CLAIMS if claim.id in claims}


def context(evidence: Evidence) -> dict:
    """Everything that the page may say."""
    summary = evidence.summary().set_index(["scenario", "learner"])
    claims = {claim["id"]: claim for claim in evidence.claims()}
    return {
        "n": n,
        "one": one,
        "shipped": evidence.shipped,
        "figures": "figures" if evidence.shipped else "../figures",
        "own": summary.loc[(evidence.fact("scenario"), evidence.fact("improved"))],
        "typical": typical_errors(claims["figure-1"]),
        "claims": claims,
        "in_a_line": _in_a_line(claims),
        "universes": max((claim["universes"] or {"of": 0})["of"] for claim in claims.values()),
        "published": PUBLISHED,
        "enough": f"{CLAIM.limits['factor']:g}",
    }
