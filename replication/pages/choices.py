"""What the page of choices says: what the paper leaves open, and what this study took."""

from replication.judgement.results import Evidence
from replication.pages.words import amounts

NEEDS = """
    assignments/{robot}.parquet search/{improved}.csv short_searches searches_long setups
    scenarios/{scenario}.json scenarios/translation.json scenarios/rotation.json
"""


def context(evidence: Evidence) -> dict:
    """Everything that the page may say."""
    improved = evidence.facts["improved"]
    searches = evidence.sought(improved).searches
    return {
        "setups": evidence.facts["setups"]["outcomes"],
        "damages": "; ".join(map(amounts, evidence.scenario()["damages"])),
        "assignments": len(evidence.assignments()),
        "translation": amounts(evidence.scenario("translation")["damages"][0]),
        "rotation": amounts(evidence.scenario("rotation")["damages"][0]),
        "trials": len(evidence.sample(improved)) // searches,
        "searches": searches,
        "short": evidence.facts["short_searches"],
        "searches_long": evidence.facts["searches_long"],
    }
