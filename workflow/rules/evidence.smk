"""From histories to tables."""


RUN_SCENARIOS = list(dict.fromkeys(scenario for scenario, _ in RUNS))


rule summary:
    input:
        code=code("summarise.py"),
        histories=histories(RUNS),
        scenarios=[rules.scenario.output[0].format(scenario=scenario) for scenario in RUN_SCENARIOS],
    output:
        f"{RESULTS}/summary.csv",
    params:
        runs=RUNS,
        scenarios=RUN_SCENARIOS,
        seed=config["seed"],
    message:
        "Put the final errors of every training into one table"
    script:
        "../scripts/summarise.py"


rule study_mapping:
    input:
        code=code("study_mapping.py"),
        scenarios=[rules.scenario.output[0].format(scenario=scenario) for scenario in SCENARIOS],
        paper=rules.scenario.output[0].format(scenario=PAPER),
    output:
        coupling=f"{RESULTS}/studies/coupling.parquet",
        propagation=f"{RESULTS}/studies/propagation.parquet",
    params:
        studies=config["studies"],
        seed=config["seed"],
    message:
        "Measure what sections 4 and 5 say of the true mapping"
    script:
        "../scripts/study_mapping.py"


rule study_visits:
    input:
        code=code("study_visits.py"),
    output:
        f"{RESULTS}/studies/visits.parquet",
    params:
        seed=config["seed"],
    message:
        "Measure the expected learning of section 6"
    script:
        "../scripts/study_visits.py"


ENSEMBLE = EXPERIMENTS["ensemble"]


rule ensemble_chunk:
    input:
        code=code("ensemble.py"),
        table=rules.assignments.output.table.format(robot=config["robot"]),
    output:
        f"{RESULTS}/chunks/ensemble/{{series}}.{{learner}}.{{chunk}}.parquet",
    params:
        plan=lambda w: ENSEMBLE[w.learner][w.series],
        robots=lambda w: bounds(w.chunk, ENSEMBLE[w.learner][w.series]["robots"], EXPERIMENTS["robots_per_job"]),
        learner=lambda w: entry_of(w.learner),
        tests=TRAINING["tests"],
        seed=config["seed"],
    message:
        "Train {wildcards.learner} on robots {params.robots[0]} to {params.robots[1]} of the series {wildcards.series}"
    script:
        "../scripts/ensemble.py"


rule ensemble:
    input:
        code=code("concat.py"),
        chunks=lambda w: [
            rules.ensemble_chunk.output[0].format(**w, chunk=chunk)
            for chunk in chunks(ENSEMBLE[w.learner][w.series]["robots"], EXPERIMENTS["robots_per_job"])
        ],
    output:
        f"{RESULTS}/ensemble/{{series}}.{{learner}}.parquet",
    message:
        "Put the robots of the series {wildcards.series} for {wildcards.learner} together"
    script:
        "../scripts/concat.py"


rule study_replay:
    input:
        code=code("study_replay.py"),
        scenario=rules.scenario.output[0].format(scenario=PAPER),
    output:
        f"{RESULTS}/studies/replay.parquet",
    params:
        name="improved",
        learner=lambda w: entry_of("improved"),
        seed=config["seed"],
    message:
        "Teach the improved learner by a table instead of a robot"
    script:
        "../scripts/study_replay.py"


ENSEMBLES = {
    (series, learner): rules.ensemble.output[0].format(series=series, learner=learner)
    for learner, of_learner in ENSEMBLE.items()
    for series in of_learner
}
CRITERIA, TRIALS = "workflow/criteria.yaml", f"{config['tuned']}/trials.csv"


rule claims:
    input:
        code=code("claims.py"),
        criteria=CRITERIA,
        histories=histories(RUNS),
        studies=[*rules.study_mapping.output, *rules.study_visits.output, *rules.study_replay.output],
        assignments=rules.assignments.output.table.format(robot=config["robot"]),
    output:
        f"{RESULTS}/claims.json",
    params:
        trials=digest(TRIALS),
        published=config["paper_damage"]["published"],
        seed=config["seed"],
    message:
        "Judge every claim of the paper"
    script:
        "../scripts/claims.py"


rule pages:
    input:
        code=code("pages.py"),
        templates=["workflow/templates/README.md.j2", "workflow/templates/findings.md.j2"],
        claims=rules.claims.output[0],
        summary=rules.summary.output[0],
        ensembles=list(ENSEMBLES.values()),
    output:
        update("README.md"),
        update("docs/findings.md"),
    message:
        "Write the numbers into README and findings"
    script:
        "../scripts/pages.py"
