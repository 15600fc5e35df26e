"""What the README says of the results."""

from recalib.study.evidence.claims.speed_up import FACTOR
from recalib.study.evidence.needs import Request
from recalib.study.evidence.results import Evidence
from recalib.study.evidence.words import amounts, brief, in_universes, n, pair, verdicts
from recalib.study.measured import ERRORS, UNITS


def needs(ask: Request) -> None:
    """What the page reads."""
    ask.summary()
    ask.claims()
    ask.assignments()
    for scenario in (None, "translation", "rotation"):
        ask.scenario(scenario)
    ask.sample(ask.fact("improved"))
    for fact in ("published", "short_searches", "searches_long"):
        ask.fact(fact)


def context(evidence: Evidence) -> dict:
    """Everything that the page may say."""
    summary = evidence.summary()
    rows = {(row["scenario"], row["learner"]): row for row in summary.to_dict("records")}
    improved, claims = evidence.fact("improved"), evidence.claims()
    figure_1 = next(claim for claim in claims if claim["id"] == "figure-1")["measured"]
    return {
        "n": n,
        "pair": pair,
        "brief": brief,
        "verdicts": verdicts,
        "in_universes": in_universes,
        "universes": max((claim["universes"] or {"of": 0})["of"] for claim in claims),
        "shipped": evidence.shipped,
        "study": evidence.study,
        "figures": "figures" if evidence.shipped else "../figures",
        "own": rows[evidence.fact("scenario"), improved],
        "typical": ", ".join(f"{n(figure_1[f'final {unit}'])} {unit}" for unit in UNITS),
        "summary": list(rows.values()),
        "claims": claims,
        "published": " and ".join(
            f"{evidence.fact('published')[error]:g} {unit}"
            for error, unit in zip(ERRORS, UNITS, strict=True)
        ),
        "factor": FACTOR,
        "damages": "; ".join(map(amounts, evidence.scenario()["damages"])),
        "assignments": len(evidence.assignments()),
        "translation": amounts(evidence.scenario("translation")["damages"][0]),
        "rotation": amounts(evidence.scenario("rotation")["damages"][0]),
        "trials": len(evidence.sample(improved)) // evidence.searched_for(improved).searches,
        "short": evidence.fact("short_searches"),
        "searches_long": evidence.fact("searches_long"),
    }
