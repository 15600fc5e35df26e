"""The comparison with today's learners. It is not part of the default run."""


rule benchmark_run:
    input:
        settings=SETTINGS,
    output:
        f"{RESULTS}/benchmark/{{learner}}.parquet",
    log:
        f"{RESULTS}/logs/benchmark/{{learner}}.log",
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        **calls("training.benchmark:compete"),
        learner=lambda w: w.learner,
    message:
        "Train {wildcards.learner} on the benchmark's scenarios"
    script:
        "../scripts/call.py"


rule benchmark_table:
    input:
        histories=[
            f"{RESULTS}/benchmark/{learner}.parquet"
            for learner in (*STUDY.benchmark.learners, *STUDY.benchmark.papers)
        ],
    output:
        errors=f"{RESULTS}/benchmark.csv",
        reached=f"{RESULTS}/benchmark_moves.csv",
    log:
        f"{RESULTS}/logs/benchmark_table.log",
    localrule: True
    params:
        **calls("judgement.error_tables:put_together"),
        digits=6,
    message:
        "Collect the results of the benchmark"
    script:
        "../scripts/call.py"


rule real_data:
    output:
        fit=f"{RESULTS}/real/fit.csv",
        test=f"{RESULTS}/real/test.csv",
    log:
        f"{RESULTS}/logs/real_data.log",
    localrule: True
    params:
        **calls("training.tracker:fetch"),
    message:
        "Download the poses of the real arm"
    script:
        "../scripts/call.py"


rule real_run:
    input:
        fit=f"{RESULTS}/real/fit.csv",
        test=f"{RESULTS}/real/test.csv",
        description=STUDY.real.description,
        settings=SETTINGS,
    output:
        f"{RESULTS}/real/{{learner}}.csv",
    log:
        f"{RESULTS}/logs/real/{{learner}}.log",
    wildcard_constraints:
        learner="|".join([*STUDY.real.learners, *STUDY.real.twin]),
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        **calls("training.real_arm:learn"),
        learner=lambda w: w.learner,
    message:
        "Train {wildcards.learner} on recorded poses of the real arm"
    script:
        "../scripts/call.py"


rule real_table:
    input:
        runs=[
            f"{RESULTS}/real/{learner}.csv" for learner in (*STUDY.real.learners, *STUDY.real.twin)
        ],
    output:
        f"{RESULTS}/real.csv",
    log:
        f"{RESULTS}/logs/real_table.log",
    localrule: True
    params:
        **calls("judgement.error_tables:real_errors"),
        digits=5,
    message:
        "Collect the results on the real arm"
    script:
        "../scripts/call.py"
