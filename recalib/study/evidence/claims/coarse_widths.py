"""Section 6: what wide and narrow neighbourhoods cost."""

from recalib.study.evidence.claims.claim import Claim, Finding, Limit, of_all
from recalib.study.evidence.verdicts import Comparison
from recalib.study.inference.hierarchy import geometric_student

FEW, MANY = Limit(20.0), Limit(10.0)


def measure(evidence, limits):
    table = evidence.table("mapping/widths.parquet")
    taken = table.pivot(index="seed", columns="width", values="iterations")
    wide, more = (
        geometric_student(values.to_numpy())
        for values in (taken["wide"], taken["narrow"] / taken["wide"])
    )
    rates = table.groupby("width")["rate"].first()
    note = (
        f"The rates are {rates['wide']:g} and {rates['narrow']:g}, the best on other poses. The"
        f" intervals hold the luck of {len(taken)} seeds, and not that of this choice."
    )
    verdict = of_all(
        Comparison(limits["many"], below=False).verdict(more),
        Comparison(limits["few"]).verdict(wide),
    )
    estimates = {"narrow / wide": more, "iterations with wide neighbourhoods": wide}
    return Finding(estimates, verdict, note=note)


CLAIM = Claim(
    id="coarse-widths",
    section="6",
    quotation="When the neighborhood width is large [...] Few iterations are then required to learn"
    " the mapping in all the input space at a coarse level of resolution. Instead, when the"
    " neighborhoods are small [...] many more iterations are required",
    statement="Wide neighbourhoods learn a coarse mapping in few iterations, narrow ones in many.",
    short="{number} times as many",
    limits={"few": FEW, "many": MANY},
    criterion="With constant widths, both errors of the improved system are halved after at most"
    " {few} iterations where neighbourhoods are as wide as half of the workspace, and after"
    " at least {many} times as many where they are as wide as half of the distance between cells.",
    reason="Few is a tenth of Figure 1's iterations, many more an order of magnitude. Each width"
    " has the best of four constant rates, 0.8 at most.",
    needs="mapping/widths.parquet",
    measure=measure,
)
