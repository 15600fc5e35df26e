"""The second campaign: the replication in many setups. No part of the default run."""

from functools import cache

from recalib.study.layout import DESIGN, PIECES
from recalib.study.multiverse.design import digest, read_design
from recalib.study.multiverse.universe import universe

REPLICATES = 8  # of the reference study


@cache
def designed():
    """The committed design."""
    return read_design(ROOT / DESIGN)


def universe_of(wildcards):
    """A universe of the design, as its job needs it."""
    return universe(study(wildcards), designed()[int(wildcards.number)])


def setups(table):
    """The universes in which a table is measured."""
    every = range(len(designed()))
    sought = set(STUDIES[MAIN].universes.horizons)
    return [n for n in every if n in sought] if table == "horizon" else [*every]


def pieces(table):
    """All pieces of a table."""
    return Layout(MAIN).campaign_pieces(table, len(setups(table)))


def piece_of(wildcards):
    """The chunks of a piece."""
    size, table = PIECES[wildcards.table], wildcards.table
    numbers = setups(table)[int(wildcards.piece) * size :][:size]
    return [Layout(MAIN).campaign_chunk(table, number) for number in numbers]


def effort_trainings():
    """The trainings whose effort is varied: the ladders, and the improved system's own length."""
    its, ladders = STUDIES[MAIN], STUDIES[MAIN].experiments.ladder
    own = its.learners["improved"].iterations
    rungs = {name: its_rungs for name, its_rungs in ladders.items() if name != "improved"}
    return [f"improved_{own}", *(f"{name}_{rung}" for name in rungs for rung in rungs[name])]


wildcard_constraints:
    table="outcomes|horizon",
    piece=r"\d+",
    number=r"\d+",


rule design:
    output:
        LAYOUT.campaign("design"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=60),
    params:
        code=made_from("design.py"),
        job=lambda w: as_text(plan(w).design()),
    message:
        "Draw the universes of the multiverse"
    script:
        "../scripts/design.py"


rule power:
    output:
        LAYOUT.campaign("power"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=60),
    params:
        code=made_from("power.py"),
        setups=lambda w: study(w).universes.count,
        replicates=lambda w: study(w).universes.replicates,
    message:
        "Try the model of the campaign in worlds whose truth is known"
    script:
        "../scripts/power.py"


rule universe:
    output:
        LAYOUT.campaign_chunk("outcomes", "{number}"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=30),
    params:
        code=made_from("universe.py"),
        job=lambda w: as_text(universe_of(w)),
    message:
        "Measure universe {wildcards.number}"
    script:
        "../scripts/universe.py"


rule horizon:
    output:
        LAYOUT.campaign_chunk("horizon", "{number}"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=60),
    params:
        code=made_from("horizon.py"),
        job=lambda w: as_text(universe_of(w)),
    message:
        "Seek how long Ritter's takes in universe {wildcards.number}"
    script:
        "../scripts/horizon.py"


rule piece:
    input:
        chunks=piece_of,
    output:
        LAYOUT.campaign("{table}_{piece}"),
    localrule: True
    params:
        code=made_from("piece.py"),
        design=lambda w: digest(ROOT / DESIGN),
    message:
        "Put piece {wildcards.piece} of the {wildcards.table} together"
    script:
        "../scripts/piece.py"


rule universes:
    input:
        lambda w: pieces("outcomes"),
    message:
        "What was measured in every universe: {input}; `make universes` ships it"


rule horizons:
    input:
        lambda w: pieces("horizon"),
    message:
        "How long Ritter's takes in universes: {input}; `make horizons` ships it"


rule reference_replicate:
    input:
        scenario=own_scenario,
    output:
        LAYOUT.campaign_chunk("reference", "{number}"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=30),
    params:
        code=made_from("reference.py"),
        study=lambda w: study(w).model_dump_json(),
    message:
        "Measure replicate {wildcards.number} of the reference study"
    script:
        "../scripts/reference.py"


rule efforts_of:
    input:
        scenario=own_scenario,
        sample=lambda w: sample_at(w.root, w.training),
    output:
        LAYOUT.campaign_chunk("efforts", "{training}"),
    threads: 1
    resources:
        **room(mem_mb=4000, runtime=30),
    params:
        code=made_from("efforts.py", reads=lambda w: [sample_at(w.root, w.training)]),
        job=lambda w: as_text(plan(w).efforts(w.training)),
    message:
        "Train the winners of full and of rough searches for {wildcards.training}"
    script:
        "../scripts/efforts.py"


rule reference:
    input:
        chunks=[Layout(MAIN).campaign_chunk("reference", n) for n in range(REPLICATES)],
    output:
        Layout(MAIN).campaign("reference"),
    localrule: True
    params:
        code=made_from("piece.py"),
        design="",  # they follow none
    script:
        "../scripts/piece.py"


rule efforts:
    input:
        chunks=[Layout(MAIN).campaign_chunk("efforts", name) for name in effort_trainings()],
    output:
        Layout(MAIN).campaign("efforts"),
    localrule: True
    params:
        code=made_from("piece.py"),
        design="",  # they follow none
    script:
        "../scripts/piece.py"
