"""What should one use today? No part of the default run."""

from replication.training.competitors import TWIN, homes_of
from replication.training.trainings import rules_unless_peer


def sample_of_competitor(wildcards):
    """The sample for a learner of the paper; today's need none."""
    papers = rules_unless_peer(study(wildcards), wildcards.learner)
    return sample(wildcards, wildcards.learner) if papers else []


rule benchmark_run:
    input:
        scenarios=lambda w: [
            f"{w.root}/scenarios/{name}.json" for name in study(w).benchmark.scenarios
        ],
        sample=sample_of_competitor,
    output:
        "{root}/chunks/benchmark/{learner}.parquet",
    log:
        "{root}/logs/benchmark_run/{learner}.log",
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=10),
    params:
        **calls(
            "replication.training.benchmark.compete",
            also=lambda w: homes_of([w.learner]),
            reads=lambda w: [sample_of_competitor(w)],
        ),
        arguments=lambda w: as_text(
            name=w.learner,
            rules=rules_unless_peer(study(w), w.learner),
            seeds=study(w).benchmark.seeds,
            moves=study(w).benchmark.moves,
            longer=study(w).benchmark.longer,
            tests=study(w).training.tests,
            seed=study(w).seed,
        ),
    message:
        "Let {wildcards.learner} work through the benchmark's scenarios"
    script:
        "../scripts/call.py"


rule benchmark_table:
    input:
        histories=lambda w: expand(
            "{root}/chunks/benchmark/{learner}.parquet",
            root=w.root,
            learner=study(w).benchmark.learners,
        ),
    output:
        errors="{root}/benchmark.csv",
        reached="{root}/benchmark_moves.csv",
        seconds="{root}/benchmark_seconds.csv",  # which differ from run to run
    log:
        "{root}/logs/benchmark_table.log",
    localrule: True
    params:
        **calls("replication.judgement.benchmark.put_together"),
        arguments=lambda w: as_text(
            scenarios=study(w).benchmark.scenarios,
            learners=study(w).benchmark.learners,
            thresholds=study(w).benchmark.thresholds,
            seed=study(w).seed,
        ),
        digits=6,
    message:
        "Put the benchmark together"
    script:
        "../scripts/call.py"


rule real_data:
    output:
        table="{root}/real/{part}.csv",
    log:
        "{root}/logs/real_data/{part}.log",
    wildcard_constraints:
        part="fit|test",
    localrule: True
    params:
        **calls("replication.training.tracker.fetch"),
        arguments=lambda w: as_text(source=getattr(study(w).real.data, w.part)),
    message:
        "Bring the poses of the real arm to {wildcards.part}"
    script:
        "../scripts/call.py"


rule real_run:
    input:
        fit="{root}/real/fit.csv",
        test="{root}/real/test.csv",
        description=lambda w: study(w).real.description,
    output:
        "{root}/real/runs/{learner}.csv",
    log:
        "{root}/logs/real_run/{learner}.log",
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=10),
    params:
        **calls(
            "replication.training.real_arm.learn_from_tables",
            also=lambda w: homes_of([w.learner]),
            reads=lambda w: [study(w).real.description],
        ),
        arguments=lambda w: as_text(
            nominal=nominal(study(w), study(w).real.robot),
            learner=w.learner,
            poses=study(w).real.poses,
            subsets=study(w).real.subsets,
            seed=study(w).seed,
        ),
    message:
        "Let {wildcards.learner} learn from recorded poses of the real arm"
    script:
        "../scripts/call.py"


rule real_twin:
    input:
        fit="{root}/real/fit.csv",
        description=lambda w: study(w).real.description,
        sample=lambda w: sample(w, w.learner),
    output:
        "{root}/real/twin/{learner}.csv",
    log:
        "{root}/logs/real_twin/{learner}.log",
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=10),
    params:
        **calls(
            "replication.training.real_arm.learn_on_twin",
            also=lambda w: homes_of([TWIN]),
            reads=lambda w: [study(w).real.description, sample(w, w.learner)],
        ),
        arguments=lambda w: as_text(
            nominal=nominal(study(w), study(w).real.robot),
            name=w.learner,
            rules=rules_of(study(w), w.learner),
            poses=study(w).real.poses,
            subsets=study(w).real.subsets,
            tests=study(w).training.tests,
            seed=study(w).seed,
        ),
    message:
        "Let {wildcards.learner} learn on a twin of the real arm"
    script:
        "../scripts/call.py"


rule real_table:
    input:
        runs=lambda w: [
            *(f"{w.root}/real/runs/{learner}.csv" for learner in study(w).real.learners),
            *(f"{w.root}/real/twin/{learner}.csv" for learner in study(w).real.twin),
        ],
    output:
        "{root}/real.csv",
    log:
        "{root}/logs/real_table.log",
    localrule: True
    params:
        **calls("replication.pages.real_arm.put_together"),
        arguments=lambda w: as_text(seed=study(w).seed),
        digits=5,
    message:
        "Put the results on the real arm together"
    script:
        "../scripts/call.py"
