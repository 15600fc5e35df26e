"""The second campaign: the replication in many setups. No part of the default run."""

from functools import cache

from recalib.files.storage import digest
from replication.config import shipped
from replication.campaign.design import read_design
from replication.campaign.universe import universe

REPLICATES = 8  # of the reference study


@cache
def designed():
    """The committed design."""
    return read_design(ROOT / shipped.DESIGN)


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
    return shipped.pieces(table, len(setups(table)), f"{MAIN}/universes")


def piece_of(wildcards):
    """The chunks of a piece."""
    size, table = shipped.PIECES[wildcards.table], wildcards.table
    numbers = setups(table)[int(wildcards.piece) * size :][:size]
    return [f"{MAIN}/chunks/universes/{table}/{number}.csv" for number in numbers]


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


def setting(study):
    """What a design is drawn for: the study's own robot is the first."""
    robots = dict.fromkeys([study.robot, *study.universes.factors.robot])
    return dict(
        plan=study.universes,
        robots=[nominal(study, name) for name in robots],
        damage=study.paper_damage,
        moved=damage(study, "translation_rotation"),
    )


rule design:
    output:
        "{root}/universes/design.csv",
    log:
        "{root}/logs/design.log",
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=60),
    params:
        **calls("replication.campaign.drawing.design"),
        arguments=lambda w: as_text(setting=setting(study(w))),
    message:
        "Draw the universes of the multiverse"
    script:
        "../scripts/call.py"


rule power:
    output:
        "{root}/universes/power.csv",
    log:
        "{root}/logs/power.log",
    benchmark:
        "{root}/logs/power.tsv"
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=60),
    params:
        **calls("replication.campaign.power.power"),
        arguments=lambda w: as_text(
            setups=study(w).universes.count,
            replicates=study(w).universes.replicates,
        ),
        digits=4,
    message:
        "Try the model of the campaign in worlds whose truth is known"
    script:
        "../scripts/call.py"


rule universe:
    output:
        "{root}/chunks/universes/outcomes/{number}.csv",
    log:
        "{root}/logs/universe/{number}.log",
    benchmark:
        "{root}/logs/universe/{number}.tsv"
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=30),
    params:
        **calls("replication.campaign.measuring.measure"),
        arguments=lambda w: as_text(universe=universe_of(w)),
        digits=6,
    message:
        "Measure universe {wildcards.number}"
    script:
        "../scripts/call.py"


rule horizon:
    output:
        "{root}/chunks/universes/horizon/{number}.csv",
    log:
        "{root}/logs/horizon/{number}.log",
    benchmark:
        "{root}/logs/horizon/{number}.tsv"
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=60),
    params:
        **calls("replication.campaign.horizon.horizon"),
        arguments=lambda w: as_text(universe=universe_of(w)),
        digits=6,
    message:
        "Seek how long Ritter's takes in universe {wildcards.number}"
    script:
        "../scripts/call.py"


rule piece:
    input:
        chunks=piece_of,
    output:
        "{root}/universes/{table}_{piece}.csv",
    log:
        "{root}/logs/piece/{table}.{piece}.log",
    localrule: True
    params:
        **calls("replication.campaign.design.put_together"),
        arguments=lambda w: as_text(design=digest((ROOT / shipped.DESIGN).read_bytes())),
        digits=6,
    message:
        "Put piece {wildcards.piece} of the {wildcards.table} together"
    script:
        "../scripts/call.py"


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
        "{root}/chunks/universes/reference/{number}.csv",
    log:
        "{root}/logs/reference_replicate/{number}.log",
    benchmark:
        "{root}/logs/reference_replicate/{number}.tsv"
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=30),
    params:
        **calls("replication.campaign.reference.reference"),
        arguments=lambda w: as_text(study=study(w), number=int(w.number)),
        digits=6,
    message:
        "Measure replicate {wildcards.number} of the reference study"
    script:
        "../scripts/call.py"


rule efforts_of:
    input:
        scenario=own_scenario,
        sample=lambda w: sample_at(w.root, w.training),
    output:
        "{root}/chunks/universes/efforts/{training}.csv",
    log:
        "{root}/logs/efforts_of/{training}.log",
    benchmark:
        "{root}/logs/efforts_of/{training}.tsv"
    threads: 1
    resources:
        **room(mem_mb=4000, runtime=30),
    params:
        **calls(
            "replication.campaign.efforts.efforts",
            reads=lambda w: [sample_at(w.root, w.training)],
        ),
        arguments=lambda w: as_text(
            training=w.training,
            learner=rules_of(study(w), w.training),
            rough_trials=study(w).universes.rough_trials,
            seeds=study(w).training.seeds,
            tests=study(w).training.tests,
            seed=study(w).seed,
        ),
        digits=4,
    message:
        "Train the winners of full and of rough searches for {wildcards.training}"
    script:
        "../scripts/call.py"


rule reference:
    input:
        chunks=[f"{MAIN}/chunks/universes/reference/{n}.csv" for n in range(REPLICATES)],
    output:
        f"{MAIN}/universes/reference.csv",
    log:
        f"{MAIN}/logs/reference.log",
    localrule: True
    params:
        **calls("replication.campaign.design.put_together"),
        digits=6,
    script:
        "../scripts/call.py"


rule efforts:
    input:
        chunks=[f"{MAIN}/chunks/universes/efforts/{name}.csv" for name in effort_trainings()],
    output:
        f"{MAIN}/universes/efforts.csv",
    log:
        f"{MAIN}/logs/efforts.log",
    localrule: True
    params:
        **calls("replication.campaign.design.put_together"),
        digits=6,
    script:
        "../scripts/call.py"
