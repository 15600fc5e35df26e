"""The multiverse: the replication in many readings of the paper. No part of the default run."""


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
