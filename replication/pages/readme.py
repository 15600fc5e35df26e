"""What the README says of the results: those that matter, and a verdict on every claim."""

from collections.abc import Mapping

from replication.config.shipped import EFFORTS
from replication.judgement.claims import CLAIMS
from replication.judgement.factor import AS_THE_PAPER, CELLS, PUBLISHED, factor_table, verdict
from replication.judgement.intervals import Estimate
from replication.judgement.results import Evidence
from replication.judgement.verdicts import Verdict
from replication.pages.parts import otherwise, parts
from replication.pages.words import (
    headline,
    of_others,
    one,
    percent,
    short,
    typical_errors,
)

NEEDS = f"""
    summary.csv claims.json improved scenario outcomes? {EFFORTS}?
    runs/{{scenario}}/{{ladder}}.parquet seed iterations
"""
ORDINARY = {
    Verdict.SUPPORTED: f"which agrees with {PUBLISHED}",
    Verdict.CONTRADICTED: "which does not agree",
    Verdict.UNDECIDED: f"which agrees with {PUBLISHED} and with much else",
}


def in_a_sentence(claims: Mapping[str, Mapping]) -> dict[str, str]:
    """Each claim with the number that judges it, by its id; of which system, if others differ."""
    return {
        claim.id: _of_its_system(claims[claim.id], claim.short)
        for claim in CLAIMS
        if claim.id in claims
    }


def _of_its_system(claim: Mapping, sentence: str) -> str:
    said = sentence.format(number=headline(claim, short), percent=headline(claim, percent))
    its = claim["universes"]
    if "holds" in its and its["holds"] < its["setups"]:
        said += f"; holds in {its['holds']} of {its['setups']}"
    if others := of_others(claim):
        return "; ".join([f"{next(iter(claim['systems']))}: {said}", *others])
    return said


def _readings(claim: Mapping) -> dict[str, dict[str, str]]:
    """For each reading of the paper, the factor and whether the published one agrees with it."""
    found = {}
    for name, cells in CELLS.items():
        label = f"factor, as many cells as {cells}"
        estimate = Estimate(claim["measured"][label], *claim["interval"][label])
        found[name] = {"factor": one(claim, label), "so": ORDINARY[verdict(estimate)]}
    return found


def _ways(evidence: Evidence) -> dict:
    """Of the ways to ask for the factor, how many agree with the published one, and the paper's."""
    if EFFORTS not in evidence.files:
        return {}
    rows = factor_table(evidence)
    return {
        "count": len(rows),
        "agree": sum(row["verdict"] == Verdict.SUPPORTED for row in rows),
        "as_the_paper": next(row["factor"] for row in rows if row["effort"] == AS_THE_PAPER),
    }


def context(evidence: Evidence) -> dict:
    """Everything that the page may say."""
    summary = evidence.table("summary.csv").set_index(["scenario", "learner"])
    claims = {claim["id"]: claim for claim in evidence.claims()}
    measured = [claim["universes"] for claim in claims.values()]
    return {
        "shipped": evidence.shipped,
        "figures": "figures" if evidence.shipped else "../figures",
        "own": summary.loc[(evidence.facts["scenario"], evidence.facts["improved"])],
        "typical": typical_errors(claims["figure-1"]),
        "claims": claims,
        "sentences": in_a_sentence(claims),
        "verdicts": [str(verdict) for verdict in Verdict],
        "setups": max((its.get("setups", 0) for its in measured), default=0),
        "otherwise": otherwise(parts(evidence)),
        "published": PUBLISHED,
        "readings": _readings(claims["speed-up"]),
        "ways": _ways(evidence),
    }
