"""What the paper says of the true mapping, measured without a learner, and of the controller."""


rule study_mapping:
    input:
        scenarios=lambda w: [layout(w).scenario(name) for name in study(w).experiments.scenarios],
        own=own_scenario,
    output:
        coupling=LAYOUT.mapping("coupling"),
        propagation=LAYOUT.mapping("propagation"),
        quantisation=LAYOUT.mapping("quantisation"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        code=made_from("study_mapping.py"),
        job=lambda w: as_text(plan(w).true_mapping()),
    message:
        "Measure what section 3 says of the cells, and sections 4 and 5 of the true mapping"
    script:
        "../scripts/study_mapping.py"


rule study_visits:
    output:
        LAYOUT.mapping("visits"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        code=made_from("study_visits.py"),
        job=lambda w: as_text(plan(w).visits()),
    message:
        "Measure the expected learning of section 6"
    script:
        "../scripts/study_visits.py"


rule study_replay:
    input:
        scenario=own_scenario,
        sample=lambda w: sample(w, "improved"),
    output:
        LAYOUT.mapping("replay"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        code=made_from("study_replay.py", reads=lambda w: [sample(w, "improved")]),
        job=lambda w: as_text(plan(w).replay()),
    message:
        "Teach the improved learner by a table instead of a robot"
    script:
        "../scripts/study_replay.py"
