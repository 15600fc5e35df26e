"""Section 4: two maps in place of one, and what each of them wants."""

from recalib.study.evidence.claims.across import Across
from recalib.study.evidence.claims.claim import Claim
from recalib.study.evidence.verdicts import CORRELATION

RATIO_OF = "error with two maps / with one"

SEPARATE = Claim(
    id="separate-maps",
    section="4",
    quotation="This modification leads to a significant increase in learning speed.",
    statement="Two maps, one for positions and one for orientations, learn faster than one.",
    short="error x {number}",
    criterion="Ritter's error after 1,000 iterations with two maps over that with one is below 1."
    " Both searches go on from the same winner with as many trials.",
    reason="Section 4 speaks of Ritter's framework. After 200 iterations most of Ritter's error"
    " remains, too much to show a difference. One map is two maps with equal widths.",
    across={
        "Ritter's, 1,000 iterations": Across("maps_ritter_late", RATIO_OF),
        "Ritter's, 200 iterations": Across("maps_ritter", RATIO_OF),
        "improved system, 200 iterations": Across("maps_improved", RATIO_OF),
    },
    figures=("figure4", "figure5"),
)

ORDER = "All trials of the first round enter; each has widths of its own."
WIDTHS = {
    kind: Claim(
        id=f"widths-{kind}",
        section="4",
        quotation=words,
        statement=f"The {kind} map wants {wanted}.",
        short="rank correlation {number}",
        criterion=f"The rank correlation of the {kind} error with log({over}) is above 0.",
        reason=ORDER,
        across={"improved system": Across(f"order_{kind}", "rank correlation", CORRELATION, False)},
        figures=("figure6",),
    )
    for kind, words, wanted, over in (
        (
            "position",
            "one with a narrow g_k and a wide g_kl to compute only position commands",
            "narrow neighbourhoods of positions and wide ones of orientations",
            "g_k / g_kl",
        ),
        (
            "orientation",
            "another with a wide g_k and a narrow g_kl to compute only orientation commands",
            "wide neighbourhoods of positions and narrow ones of orientations",
            "g_kl / g_k",
        ),
    )
}

LARGE = Claim(
    id="large-neighbourhoods",
    section="4",
    quotation="too large neighborhoods in the position coordinates space are counterproductive to"
    " learn position commands",
    statement="Too wide neighbourhoods of positions hurt position commands.",
    short="error x {number} without them",
    criterion="The position error as tuned is below that with the position map's g_k kept as wide"
    " as the workspace, and all else tuned anew.",
    reason="No neighbourhood is larger than the workspace.",
    across={"improved system": Across("narrow", "position error as tuned / with a wide g_k")},
)

CELLS = {
    kind: Claim(
        id=f"cells-{kind}",
        section="4",
        quotation=words,
        statement=f"The {kind} map can spare cells for {kind}s.",
        short="error x {number} against sparing the others",
        criterion=f"The {kind} error with 2 x 2 x 2 cells in the {net} over that with 2 x 2 x 2"
        " in the other net is below 1, both tuned.",
        reason="What needs fewer cells loses less by having fewer.",
        across={"improved system": Across(f"cells_{kind}", "error, fewer here / in the other net")},
    )
    for kind, net, words in (
        (
            "position",
            "supernet",
            "the position network needs less units in the supernet",
        ),
        (
            "orientation",
            "subnets",
            "the orientation network saves neurons at the subnet level",
        ),
    )
}
