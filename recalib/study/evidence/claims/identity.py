"""Section 3: the intact robot."""

from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim, Finding, Limit
from recalib.study.evidence.verdicts import Comparison
from recalib.study.inference.intervals import Estimate
from recalib.study.inference.measured import ERRORS

SCENARIO = "intact"
ERROR = Limit(0.001)


def measure(evidence, limits):
    worst = evidence.history(evidence.facts["improved"], SCENARIO)[list(ERRORS)].max()
    ritter = evidence.errors(evidence.facts["short"], SCENARIO).mean(axis=(0, 1))
    note = (
        f"Ritter's map, which shares values, does not keep the identity: {ritter[0]:.2g} cm and"
        f" {ritter[1]:.2g} degrees after {evidence.facts['iterations']} iterations."
    )
    numbers = {"largest position error [cm]": worst.iloc[0]}
    numbers["largest orientation error [degrees]"] = worst.iloc[1]
    largest = Estimate(*[float(worst.max())] * 3)  # of all measurements: without an interval
    return Finding({"improved system": largest}, numbers=numbers, note=note)


CLAIM = Claim(
    id="identity",
    section="3",
    quotation="For the intact robot, this mapping is the identity.",
    statement="The intact robot needs no correction, and learns none.",
    short="largest error {number} cm or degrees",
    limits={"error": ERROR},
    criterion="The improved system's errors on the intact robot stay below {error} cm and {error}"
    " degrees in every measurement.",
    reason="Rounding and the controller's tolerance cause far smaller errors.",
    needs="runs/intact/{improved}.parquet runs/intact/{short}.parquet iterations",
    measure=measure,
    across={"improved system": Across("intact", "largest error [cm, degrees]", Comparison(ERROR))},
    figures=("figure3",),
)
