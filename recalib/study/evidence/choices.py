"""What the page of choices says: what the paper leaves open, and what this study took."""

from recalib.study.evidence.needs import Request
from recalib.study.evidence.results import Evidence
from recalib.study.evidence.words import amounts


def needs(ask: Request) -> None:
    """What the page reads."""
    ask.setups("outcomes")
    ask.assignments()
    for scenario in (None, "translation", "rotation"):
        ask.scenario(scenario)
    ask.sample(ask.fact("improved"))
    for fact in ("short_searches", "searches_long"):
        ask.fact(fact)


def context(evidence: Evidence) -> dict:
    """Everything that the page may say."""
    improved, outcomes = evidence.fact("improved"), evidence.setups("outcomes")
    searches = evidence.searched_for(improved).searches
    return {
        "setups": 0 if outcomes is None else outcomes["universe"].nunique(),
        "damages": "; ".join(map(amounts, evidence.scenario()["damages"])),
        "assignments": len(evidence.assignments()),
        "translation": amounts(evidence.scenario("translation")["damages"][0]),
        "rotation": amounts(evidence.scenario("rotation")["damages"][0]),
        "trials": len(evidence.sample(improved)) // searches,
        "searches": searches,
        "short": evidence.fact("short_searches"),
        "searches_long": evidence.fact("searches_long"),
    }
