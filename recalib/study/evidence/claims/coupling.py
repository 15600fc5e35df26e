"""Section 4: positions and orientations apart, and why."""

from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim, Finding, Limit, of_all
from recalib.study.evidence.verdicts import RATIO, Comparison
from recalib.study.inference.hierarchy import geometric_student

SMALL = Limit(0.1)
RISES = RATIO._replace(below=False)  # the paper is right above 1

CLAIM = Claim(
    id="weak-coupling",
    section="4",
    quotation="changes in position coordinates influence very slowly the orientation commands, and"
    " the same can be said about orientation coordinates with respect to position commands",
    statement="Positions hardly influence orientation commands, nor the reverse.",
    short="cross effect at most {percent} of the direct one, at 95 % of poses",
    limits={"ratio": SMALL, "poses": Limit(0.95)},
    criterion="At {poses:percent} of the poses of every scenario, the off-diagonal blocks of the"
    " true mapping's Jacobian have at most a {ratio:word} of the norm of the diagonal ones.",
    reason="*Hardly* is an order of magnitude. How a pose's error is defined can matter here only"
    " through the damage, which half of the setups choose by its initial errors.",
    across={"the mapping": Across("coupling", "off-diagonal over diagonal", Comparison(SMALL))},
    figures=("figure5",),
)


def measure(evidence, limits):
    table = evidence.table("mapping/nearness.parquet")
    table = table.assign(coupling=table[["position", "orientation"]].max(axis=1))
    own, larger = table[table["size"] == 1], table[table["size"] == limits["size"]]
    most, least = (
        its.groupby("draw")["coupling"].quantile(limits["poses"]) for its in (larger, own)
    )
    middle = larger.groupby("draw")["condition"].transform("median")
    near, far = (
        its.groupby("draw")["coupling"].median()
        for its in (larger[larger["condition"] > middle], larger[larger["condition"] <= middle])
    )
    estimates = {
        "larger box / workspace": geometric_student((most / least).to_numpy()),
        "nearer to / farther from singularities": geometric_student((near / far).to_numpy()),
    }
    poses = table["draw"].nunique() * evidence.facts["coupling_poses"]
    note = (
        f"The intervals hold the luck of {table['draw'].nunique()} draws of poses. Of the poses of"
        f" the larger box, {100 * len(larger) / poses:.0f} % are within reach, with condition"
        f" numbers from {larger['condition'].min():.0f} to {larger['condition'].max():.0f}; in the"
        f" workspace the largest is {own['condition'].max():.0f}. Size and distance from"
        " singularities were not varied apart."
    )
    return Finding(estimates, of_all(*map(RISES.verdict, estimates.values())), note=note)


REASON = Claim(
    id="weak-coupling-reason",
    section="4",
    quotation="Due to the characteristics of the workspace used (far from singularities and of"
    " small size relative to that of the robot)",
    statement="They hardly do since the workspace is small and far from singularities.",
    short="cross effect x {number} in a box twice as long",
    limits={"size": Limit(2.0), "poses": Limit(0.95)},
    criterion="With the paper's damage, the larger of both ratios of weak-coupling rises, at"
    " {poses:percent} of the poses, in a box {size:word} as long along each axis of positions. In"
    " that box it is larger, in the median, at the half of the poses with the larger condition"
    " numbers. Both whole intervals are on this side, and not within 10 %.",
    reason="Units stay those of the workspace, so a larger box changes only where poses are.",
    needs="mapping/nearness.parquet coupling_poses",
    measure=measure,
)
