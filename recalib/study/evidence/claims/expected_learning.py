"""Section 6: the expected learning (10)."""

from recalib.study.evidence.claims.claim import Claim, Finding, Limit
from recalib.study.evidence.verdicts import Verdict

SMALL = 0.3  # widths up to this one see one face of the workspace only


def measure(evidence, limits):
    table = evidence.table("mapping/visits.parquet")
    away = table[table["distance"] >= limits["away"] * table["width"]]
    deviation = (away["ratio"] - 1).abs()
    agrees = (deviation <= limits["deviation"]) & (deviation <= limits["errors"] * away["error"])
    border = table[(table["distance"] == 0) & (table["width"] <= SMALL)]["ratio"].mean()
    note = (
        f"{len(away)} combinations of width and distance; on a face of the workspace,"
        f" {border:.2f} of the formula."
    )
    return Finding(
        verdict=Verdict.SUPPORTED if agrees.all() else Verdict.CONTRADICTED,
        numbers={"largest deviation": deviation.max()},
        note=note,
    )


CLAIM = Claim(
    id="expected-learning",
    section="6",
    quotation="The second equality results from assuming Gaussian neighborhoods and a uniform p(w),"
    " and it is valid for w_r's not too close to the border",
    statement="A formula predicts how much a cell learns in an iteration.",
    short="within {percent} of Monte Carlo",
    published="equation (10)",
    limits={"deviation": Limit(0.05), "errors": Limit(3.0), "away": Limit(3.0)},
    criterion="Monte Carlo agrees within {deviation:percent} and {errors:word} of its standard"
    " errors for all cells at least {away} sigma from the border.",
    reason="No schedule would show a deviation below {deviation:percent}. Three sigma hold 99.7 %"
    " of a Gaussian. The formula is equation (10).",
    needs="mapping/visits.parquet",
    measure=measure,
    figures=("figure8",),
)
