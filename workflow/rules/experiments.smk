"""Train every learner on its scenarios: at once, or in chunks of seeds where there are many."""


def in_chunks(study):
    """Whether a training may have more seeds than a job trains."""
    most = study.training.seeds * max(study.search.searches, study.search.searches_long)
    return most > study.training.seeds_per_job


IN_CHUNKS = [root for root in STUDIES if in_chunks(STUDIES[root])]
AT_ONCE = [root for root in STUDIES if root not in IN_CHUNKS]
NOWHERE = "(?!)"


rule train:
    input:
        scenario="{root}/scenarios/{scenario}.json",
        sample=lambda w: sample(w, w.learner),
    output:
        history="{root}/runs/{scenario}/{learner}.parquet",
        learned="{root}/runs/{scenario}/{learner}.npz",
    log:
        "{root}/logs/train/{scenario}.{learner}.log",
    benchmark:
        "{root}/logs/train/{scenario}.{learner}.tsv"
    wildcard_constraints:
        root="|".join(AT_ONCE) or NOWHERE,
    priority: 10
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        **calls(
            "replication.training.campaign.train_seeds",
            reads=lambda w: [sample(w, w.learner)],
        ),
        arguments=lambda w: as_text(
            rules=rules_of(study(w), w.learner),
            seeds=study(w).training.seeds,
            **bounds(
                w.get("chunk", 0), seeds(study(w), w.learner), study(w).training.seeds_per_job
            ),
            measuring=measuring(study(w)),
            throughout=is_shown(study(w), w.scenario, w.learner),
            seed=study(w).seed,
        ),
    message:
        "Train {wildcards.learner} on {wildcards.scenario}"
    script:
        "../scripts/call.py"


use rule train as train_chunk with:
    output:
        history="{root}/chunks/runs/{scenario}/{learner}.{chunk}.parquet",
        learned="{root}/chunks/runs/{scenario}/{learner}.{chunk}.npz",
    log:
        "{root}/logs/train_chunk/{scenario}.{learner}.{chunk}.log",
    benchmark:
        "{root}/logs/train_chunk/{scenario}.{learner}.{chunk}.tsv"
    wildcard_constraints:
        root="|".join(IN_CHUNKS) or NOWHERE,
    message:
        "Train {wildcards.learner} on {wildcards.scenario}, chunk {wildcards.chunk} of its seeds"


def is_shown(study, scenario, learner):
    """Whether figures show how a training went on its way."""
    shown = *study.experiments.learners, *study.experiments.beside
    return scenario_of(study, scenario)[1] == study.robot and learner in shown


def training_chunks(wildcards):
    its = study(wildcards)
    return chunks(seeds(its, wildcards.learner), its.training.seeds_per_job)


rule run:
    input:
        histories=lambda w: expand(
            "{root}/chunks/runs/{scenario}/{learner}.{chunk}.parquet",
            chunk=training_chunks(w),
            **w,
        ),
        parts=lambda w: expand(
            "{root}/chunks/runs/{scenario}/{learner}.{chunk}.npz",
            chunk=training_chunks(w),
            **w,
        ),
    output:
        history="{root}/runs/{scenario}/{learner}.parquet",
        learned="{root}/runs/{scenario}/{learner}.npz",
    log:
        "{root}/logs/run/{scenario}.{learner}.log",
    wildcard_constraints:
        root="|".join(IN_CHUNKS) or NOWHERE,
    localrule: True
    params:
        **calls("replication.training.joining.training"),
    message:
        "Put the seeds of {wildcards.learner} on {wildcards.scenario} together"
    script:
        "../scripts/call.py"


def series_of(wildcards):
    """A series of other damages."""
    return study(wildcards).experiments.ensemble[wildcards.learner][wildcards.series]


rule ensemble_chunk:
    input:
        sample=lambda w: sample(w, w.learner),
    output:
        "{root}/chunks/ensemble/{series}.{learner}.{chunk}.parquet",
    log:
        "{root}/logs/ensemble_chunk/{series}.{learner}.{chunk}.log",
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        **calls(
            "replication.training.ensemble.train_draws",
            reads=lambda w: [sample(w, w.learner)],
        ),
        arguments=lambda w: as_text(
            nominal=nominal(study(w), study(w).robot),
            shorten=study(w).paper_damage.shorten,
            shift=study(w).paper_damage.shift,
            series=w.series,
            scales=series_of(w).scales,
            **bounds(w.chunk, series_of(w).draws, study(w).experiments.draws_per_job),
            rules=rules_of(study(w), w.learner),
            tests=study(w).training.tests,
            seed=study(w).seed,
        ),
    message:
        "Train {wildcards.learner} on other damages: {wildcards.series}, chunk {wildcards.chunk}"
    script:
        "../scripts/call.py"


rule ensemble:
    input:
        chunks=lambda w: expand(
            "{root}/chunks/ensemble/{series}.{learner}.{chunk}.parquet",
            chunk=chunks(series_of(w).draws, study(w).experiments.draws_per_job),
            **w,
        ),
    output:
        "{root}/ensemble/{series}.{learner}.parquet",
    log:
        "{root}/logs/ensemble/{series}.{learner}.log",
    localrule: True
    params:
        **calls("replication.training.joining.put_together"),
    message:
        "Put the other damages for {wildcards.learner} together: {wildcards.series}"
    script:
        "../scripts/call.py"


rule bench:
    input:
        scenario=own_scenario,
    output:
        "{root}/bench.txt",
    log:
        "{root}/logs/bench.log",
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        **calls("replication.training.speed.measure_speed"),
    message:
        "Measure the speed of moves"
    script:
        "../scripts/call.py"
