"""What should one use today? No part of the default run."""


def sample_of_entrant(wildcards):
    """The sample for a learner of the paper; today's need none."""
    papers = plan(wildcards).benchmark(wildcards.learner, wildcards.batch).learner
    return [sample(wildcards, wildcards.learner)] if papers else []


rule benchmark_run:
    input:
        scenarios=lambda w: [layout(w).scenario(name) for name in plan(w).batches()[w.batch]],
        samples=sample_of_entrant,
    output:
        LAYOUT.benchmark_batch("{learner}", "{batch}"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=10),
    params:
        code=made_from("benchmark.py", reads=sample_of_entrant),
        job=lambda w: as_text(plan(w).benchmark(w.learner, w.batch)),
    message:
        "Let {wildcards.learner} work through batch {wildcards.batch} of the benchmark's scenarios"
    script:
        "../scripts/benchmark.py"


rule benchmark_table:
    input:
        histories=lambda w: [
            layout(w).benchmark_batch(learner, batch)
            for learner in study(w).benchmark.learners
            for batch in plan(w).batches()
        ],
    output:
        table=LAYOUT.benchmark,
        reached=LAYOUT.benchmark_moves,
        seconds=LAYOUT.benchmark_seconds,
    localrule: True
    params:
        code=made_from("benchmark_table.py"),
        job=lambda w: as_text(plan(w).benchmark_table()),
    message:
        "Put the benchmark together"
    script:
        "../scripts/benchmark_table.py"


rule real_data:
    output:
        LAYOUT.real_data("{part}"),
    wildcard_constraints:
        part="fit|test",
    localrule: True
    params:
        code=made_from("real_data.py"),
        job=lambda w: as_text(plan(w).real_data(w.part)),
    message:
        "Bring the poses of the real arm to {wildcards.part}"
    script:
        "../scripts/real_data.py"


rule real_run:
    input:
        fit=LAYOUT.real_data("fit"),
        test=LAYOUT.real_data("test"),
        description=lambda w: study(w).real.description,
    output:
        LAYOUT.real_run("{learner}"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=10),
    params:
        code=made_from("real_run.py", reads=lambda w: [study(w).real.description]),
        job=lambda w: as_text(plan(w).real_run(w.learner)),
    message:
        "Let {wildcards.learner} learn from recorded poses of the real arm"
    script:
        "../scripts/real_run.py"


rule real_twin:
    input:
        fit=LAYOUT.real_data("fit"),
        description=lambda w: study(w).real.description,
        sample=lambda w: sample(w, w.learner),
    output:
        LAYOUT.real_twin("{learner}"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=10),
    params:
        code=made_from(
            "real_twin.py", reads=lambda w: [study(w).real.description, sample(w, w.learner)]
        ),
        job=lambda w: as_text(plan(w).real_twin(w.learner)),
    message:
        "Let {wildcards.learner} learn on a twin of the real arm"
    script:
        "../scripts/real_twin.py"


rule real_table:
    input:
        runs=lambda w: [
            *(layout(w).real_run(learner) for learner in study(w).real.learners),
            *(layout(w).real_twin(learner) for learner in study(w).real.twin),
        ],
    output:
        LAYOUT.real,
    localrule: True
    params:
        code=made_from("real_table.py"),
        job=lambda w: as_text(plan(w).real_table()),
    message:
        "Put the results on the real arm together"
    script:
        "../scripts/real_table.py"
