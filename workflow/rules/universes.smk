"""The multiverse: the replication in many readings of the paper. No part of the default run."""

from functools import cache

from recalib.study.layout import DESIGN
from recalib.study.multiverse.design import read_design
from recalib.study.multiverse.universe import universe


@cache
def designed():
    """The committed design."""
    return read_design(ROOT / DESIGN)


def universe_of(wildcards):
    """A universe of the design, as its job needs it."""
    return universe(study(wildcards), designed()[int(wildcards.number)])


rule design:
    output:
        LAYOUT.design,
    params:
        code=made_from("design.py"),
        job=lambda w: as_text(plan(w).design()),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=60),
    message:
        "Draw the universes of the multiverse"
    script:
        "../scripts/design.py"


rule universe:
    output:
        LAYOUT.universe("{number}"),
    params:
        code=made_from("universe.py"),
        job=lambda w: as_text(universe_of(w)),
    wildcard_constraints:
        number=r"\d+",
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    message:
        "Measure universe {wildcards.number}"
    script:
        "../scripts/universe.py"


rule outcomes:
    input:
        universes=lambda w: [layout(w).universe(each.universe) for each in designed()],
    output:
        LAYOUT.outcomes,
    params:
        code=made_from("outcomes.py"),
    localrule: True
    message:
        "Put the outcomes of all universes together"
    script:
        "../scripts/outcomes.py"


rule universes:
    input:
        Layout(MAIN).outcomes,
    message:
        "What was measured in every universe: {input}; `make universes` ships it"
