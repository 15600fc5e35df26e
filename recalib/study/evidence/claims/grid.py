"""Section 3: where the cells are."""

from recalib.study.evidence.claims.claim import Claim, Finding, Limit, of_all
from recalib.study.evidence.verdicts import RATIO, Comparison
from recalib.study.inference.hierarchy import geometric_student
from recalib.study.inference.intervals import Estimate


def measure(evidence, limits):
    table = evidence.table("mapping/quantisation.parquet")
    distances = table.pivot(index="seed", columns="placement", values="distance")

    def over(placement: str) -> Estimate:
        return geometric_student((distances["boxes"] / distances[placement]).to_numpy())

    kohonen, least = over("kohonen_10000"), over("kmeans")
    verdict = of_all(RATIO.side(kohonen), Comparison(limits["worse"]).verdict(least))
    estimates = {
        "grid / after Kohonen's rule": kohonen,
        "grid / least of k-means": least,
        "grid / grid from face to face": over("faces"),
    }
    return Finding(estimates, verdict)


CLAIM = Claim(
    id="grid",
    section="3",
    quotation="we can directly place the centers of the cells in a regular grid covering it, in"
    " order to minimize the quantization error. These centers do not need to move",
    statement="A regular grid of cells covers the workspace best.",
    short="quantisation error x {number} against Kohonen's rule",
    limits={"worse": Limit(1.1)},
    criterion="The quantisation error of the regular grid is below that of cells placed by"
    " Kohonen's rule, and at most {worse} times the least that k-means finds.",
    reason="Within a tenth of the least known counts as least. Kohonen's rule is the step that the"
    " paper leaves out.",
    needs="mapping/quantisation.parquet",
    measure=measure,
)
