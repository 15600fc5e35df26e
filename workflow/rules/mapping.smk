"""What the paper says of the true mapping, measured without a learner, and of the controller."""


rule study_mapping:
    input:
        scenarios=lambda w: expand(
            "{root}/scenarios/{scenario}.json",
            root=w.root,
            scenario=study(w).experiments.scenarios,
        ),
        own=own_scenario,
    output:
        coupling="{root}/mapping/coupling.parquet",
        nearness="{root}/mapping/nearness.parquet",
        propagation="{root}/mapping/propagation.parquet",
        quantisation="{root}/mapping/quantisation.parquet",
        solutions="{root}/mapping/solutions.parquet",
    log:
        "{root}/logs/study_mapping.log",
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        **calls("replication.mapping.measured.measure"),
        arguments=lambda w: as_text(
            poses=study(w).mapping.poses,
            balls=study(w).mapping.balls,
            points=study(w).mapping.points,
            radius=study(w).mapping.radius,
            scales=study(w).mapping.scales,
            seed=study(w).seed,
        ),
    message:
        "Measure what section 3 says of cells and commands, and sections 4 and 5 of the true mapping"
    script:
        "../scripts/call.py"


rule study_visits:
    output:
        "{root}/mapping/visits.parquet",
    log:
        "{root}/logs/study_visits.log",
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        **calls("replication.mapping.visits.visits"),
        arguments=lambda w: as_text(seed=study(w).seed),
    message:
        "Measure the expected learning of section 6"
    script:
        "../scripts/call.py"


rule study_widths:
    input:
        scenario=own_scenario,
    output:
        "{root}/mapping/widths.parquet",
    log:
        "{root}/logs/study_widths.log",
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        **calls("replication.training.constant_widths.constant_widths"),
        arguments=lambda w: as_text(rules=rules_of(study(w), "improved"), seed=study(w).seed),
    message:
        "Learn with neighbourhoods whose widths stay as they are, as section 6 compares"
    script:
        "../scripts/call.py"


rule study_replay:
    input:
        scenario=own_scenario,
        sample=lambda w: sample(w, "improved"),
    output:
        "{root}/mapping/replay.parquet",
    log:
        "{root}/logs/study_replay.log",
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        **calls(
            "replication.training.replay.replay",
            reads=lambda w: [sample(w, "improved")],
        ),
        arguments=lambda w: as_text(rules=rules_of(study(w), "improved"), seed=study(w).seed),
    message:
        "Teach the improved learner by a table instead of a robot"
    script:
        "../scripts/call.py"
