"""Section 4: positions and orientations apart."""

from recalib.study.evidence.claims.claim import Claim, Finding, Limit
from recalib.study.measured import KINDS


def needs(ask):
    ask.mapping("coupling")


def measure(evidence, limits):
    table = evidence.mapping("coupling")
    worst = table.groupby("scenario")[list(KINDS)].quantile(limits["poses"])
    labels = {f"{kind} commands": worst[kind].max() for kind in KINDS}
    note = f"Strongest in the scenario {worst.max(axis=1).idxmax()}."
    return Finding(max(labels.values()) <= limits["ratio"], labels, note=note)


CLAIM = Claim(
    id="weak-coupling",
    section="4",
    statement="In this workspace position hardly influences orientation commands, and the reverse.",
    short="Position hardly influences orientation commands, nor the reverse: ratio {}",
    published="no number",
    limits={"ratio": Limit(0.1), "poses": Limit(0.95)},
    criterion="In every scenario, the off-diagonal blocks of the true mapping's Jacobian have at"
    " most a {ratio:word} of the norm of the diagonal ones at {poses:percent} of the poses.",
    reason="Hardly is an order of magnitude.",
    needs=needs,
    measure=measure,
    figures=("figure5",),
)
