"""The multiverse: the replication in many readings of the paper. No part of the default run."""

from recalib.study.layout import DESIGN
from recalib.study.multiverse.design import read_design
from recalib.study.multiverse.universe import universe


def universe_of(wildcards):
    """A universe of the committed design, as its job needs it."""
    designed = read_design(ROOT / DESIGN)[int(wildcards.number)]
    return universe(study(wildcards), designed)


rule design:
    output:
        LAYOUT.design,
    params:
        code=code("design.py"),
        job=lambda w: as_text(plan(w).design()),
    message:
        "Draw the universes of the multiverse"
    script:
        "../scripts/design.py"


rule universe:
    output:
        LAYOUT.universe("{number}"),
    params:
        code=code("universe.py"),
        job=lambda w: as_text(universe_of(w)),
    wildcard_constraints:
        number=r"\d+",
    message:
        "Measure universe {wildcards.number}"
    script:
        "../scripts/universe.py"


rule outcomes:
    input:
        universes=lambda w: [layout(w).universe(each.universe) for each in read_design(ROOT / DESIGN)],
    output:
        LAYOUT.outcomes,
    params:
        code=code("outcomes.py"),
    message:
        "Put the outcomes of all universes together"
    script:
        "../scripts/outcomes.py"


rule universes:
    input:
        Layout(MAIN).outcomes,
    message:
        "What was measured in every universe: {input}; `make universes` ships it"
