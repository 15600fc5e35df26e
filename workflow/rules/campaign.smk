"""The campaign: every variant in every setup. It is not part of a run: its outcomes are shipped."""

from replication.campaign.setups import planned
from replication.campaign.variants import lengths, needed, variants
from replication.config.shipped import DESIGN, OUTCOMES

MEASURED = f"{RESULTS}/campaign/outcomes/{{setup}}/{{replicate}}.csv"
HALFWAY_IN_SETUP = f"{RESULTS}/campaign/halfway/{{setup}}.{{replicate}}.csv"
PIECE = f"{RESULTS}/campaign/pieces/{{setup}}/{{replicate}}/{{variant}}.csv"


wildcard_constraints:
    setup=r"\d+",
    replicate=r"\d+",
    variant=r"\w+",


def measured(wildcards):
    """The variants that are measured in a setup."""
    every = variants(STUDY).items()
    return [name for name, variant in every if lengths(variant, int(wildcards.setup))]


def pieces(wildcards, names):
    """The files of variants in a replicate of a setup."""
    replicate = {"setup": wildcards.setup, "replicate": wildcards.replicate}
    return [PIECE.format(variant=name, **replicate) for name in names]


rule design:
    output:
        f"{RESULTS}/campaign/design.csv",
    log:
        f"{RESULTS}/logs/design.log",
    resources:
        **room(mem_mb=2000, runtime=60),
    params:
        **calls("campaign.drawing:design"),
    message:
        "Draw the setups of the campaign"
    script:
        "../scripts/call.py"


rule untrained:
    input:
        design=DESIGN,
    output:
        f"{RESULTS}/campaign/untrained.csv",
    log:
        f"{RESULTS}/logs/untrained.log",
    resources:
        **room(mem_mb=2000, runtime=60),
    params:
        **calls("campaign.untrained:untrained"),
    message:
        "Measure the mapping in every setup"
    script:
        "../scripts/call.py"


# Variants are stored until their replicate is complete, so that an interrupted run can continue.
rule variant:
    input:
        design=DESIGN,
        others=lambda w: pieces(w, needed(variants(STUDY)[w.variant])),
    output:
        temp(PIECE),
    log:
        f"{RESULTS}/logs/variant/{{setup}}.{{replicate}}.{{variant}}.log",
    resources:
        **room(mem_mb=2000, runtime=60),
    params:
        **calls("campaign.measuring:measure_variant"),
        setup=lambda w: int(w.setup),
        replicate=lambda w: int(w.replicate),
        variant=lambda w: w.variant,
    message:
        "Tune {wildcards.variant} in setup {wildcards.setup}, replicate {wildcards.replicate}"
    script:
        "../scripts/call.py"


rule outcomes:
    input:
        tables=lambda w: pieces(w, measured(w)),
    output:
        MEASURED,
    log:
        f"{RESULTS}/logs/outcomes/{{setup}}.{{replicate}}.log",
    localrule: True
    params:
        **calls("campaign.measuring:put_together"),
    message:
        "Collect setup {wildcards.setup}, replicate {wildcards.replicate}"
    script:
        "../scripts/call.py"


rule campaign:
    input:
        [MEASURED.format(setup=setup, replicate=number) for setup, number in planned(STUDY)],
    message:
        "Missing outcomes of the campaign: {input}; `make campaign` ships them"


rule halfway_in_setup:
    input:
        design=DESIGN,
        outcomes=OUTCOMES,
    output:
        temp(HALFWAY_IN_SETUP),
    log:
        f"{RESULTS}/logs/halfway/{{setup}}.{{replicate}}.log",
    resources:
        **room(mem_mb=2000, runtime=60),
    params:
        **calls("campaign.halfway:halfway"),
        setup=lambda w: int(w.setup),
        replicate=lambda w: int(w.replicate),
    message:
        "Tune Ritter's map for 10,000 iterations in setup {wildcards.setup}"
    script:
        "../scripts/call.py"


# The campaign has tuned setup 0 for 10,000 iterations already.
rule halfway:
    input:
        tables=[
            HALFWAY_IN_SETUP.format(setup=setup, replicate=number)
            for setup in range(1, STUDY.campaign.setups)
            for number in range(STUDY.campaign.replicates)
            if not number or setup < STUDY.campaign.replicated
        ],
    output:
        f"{RESULTS}/campaign/halfway.csv",
    log:
        f"{RESULTS}/logs/halfway.log",
    localrule: True
    params:
        **calls("campaign.measuring:put_together"),
    message:
        "Put Ritter's map after 10,000 iterations together"
    script:
        "../scripts/call.py"
