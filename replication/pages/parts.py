"""What the verdicts would be on parts of the setups: those with one level of a choice.

The rules judge all setups together. Their parts were looked at after all outcomes had been seen, so
they explain verdicts, and change none.
"""

from collections.abc import Iterator, Mapping

from replication.judgement.claims import CLAIMS
from replication.judgement.claims.claim import Claim
from replication.judgement.intervals import Estimate
from replication.judgement.results import Evidence
from replication.pages.words import judged_by_setups

EFFORT, FULL = "effort", "full"  # of the search: rough ones scatter several times as much


def parts(evidence: Evidence) -> list[dict]:
    """A row for each level of a choice that would give a claim another verdict, or its opposite.

    The choices are the effort of the search, and the one that moves the claim most beyond chance.
    """
    judged, rows = {claim["id"]: claim for claim in evidence.claims()}, []
    for claim in CLAIMS:
        its = judged.get(claim.id)
        if its is None or not judged_by_setups(its):
            continue
        for factor in _factors(its["universes"]["depends_on"]):
            levels = list(_by_level(evidence, claim, its, factor))
            if any(level["verdict"] != its["verdict"] for level in levels):
                rows += levels
    return rows


def otherwise(rows: list[dict]) -> int:
    """How many claims would have another verdict by the setups with full effort alone."""
    full = (row for row in rows if (row["factor"], row["level"]) == (EFFORT, FULL))
    return sum(row["verdict"] != row["judged"] for row in full)


def _factors(strongest: Mapping) -> list[str]:
    beyond = [strongest["factor"]] if strongest["effect"] > strongest["chance"] else []
    return list(dict.fromkeys([EFFORT, *beyond]))


def _by_level(evidence: Evidence, claim: Claim, judged: dict, factor: str) -> Iterator[dict]:
    """What the setups with each level say of a claim, on the system on which the paper makes it."""
    system, across = next(iter(claim.across.items()))
    interval = judged["interval"].get(system, [judged["measured"][system]] * 2)
    reference = Estimate(judged["measured"][system], *interval)
    table, design = evidence.setups(across.table), evidence.levels()
    assert table is not None  # they judge it
    for level, its in table.groupby(table["universe"].map(design[factor])):
        setups = across.over(its, design)
        if setups is None:
            continue
        yield {
            "id": claim.id,
            "judged": judged["verdict"],
            "factor": factor,
            "level": level,
            "setups": len(setups.model.numbers),
            "mean": setups.mean,
            "verdict": str(setups.verdict(reference)),
        }
