"""Section 6: the expected learning (10)."""

from recalib.study.evidence.claims.claim import Claim, Finding, Limit

SMALL = 0.3  # widths up to this one see one face of the workspace only


def needs(ask):
    ask.mapping("visits")


def measure(evidence, limits):
    table = evidence.mapping("visits")
    away = table[table["distance"] >= limits["away"] * table["width"]]
    deviation = (away["ratio"] - 1).abs()
    agrees = (deviation <= limits["deviation"]) & (deviation <= limits["errors"] * away["error"])
    border = table[(table["distance"] == 0) & (table["width"] <= SMALL)]["ratio"].mean()
    note = (
        f"{len(away)} combinations of width and distance; on a face of the workspace,"
        f" {border:.2f} of the formula."
    )
    return Finding(bool(agrees.all()), {"largest deviation": deviation.max()}, note=note)


CLAIM = Claim(
    id="expected-learning",
    section="6",
    statement="The expected learning of a cell in one iteration is sigma^n (2 pi)^(n/2) / volume,"
    " not too close to the border.",
    short="A cell's expected learning is sigma^n (2 pi)^(n/2) / volume: off by {}",
    published="equation (10)",
    limits={"deviation": Limit(0.05), "errors": Limit(3.0), "away": Limit(3.0)},
    criterion="Monte Carlo agrees within {deviation:percent} and {errors:word} of its standard"
    " errors for all cells at least {away} sigma from the border.",
    reason="Three widths hold 99.7 % of a Gaussian; {deviation:percent} is below what any schedule"
    " could show.",
    needs=needs,
    measure=measure,
    figures=("figure8",),
)
