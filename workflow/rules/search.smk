"""The rough searches for widths and rates: no part of a run with samples in workflow/search."""

from functools import cache

from replication.training.chunks import bounds, chunks, searches_per_job
from replication.training.samples import searched_for, sought
from replication.training.trainings import budget, training


def sample(wildcards, learner):
    """The file with the searches for a training: the shipped one, or the study's own."""
    return sample_at(wildcards.root, str(training(study(wildcards), learner)))


@cache
def sample_at(root, name):
    shipped, wanted = Path(SEARCHED, f"{name}.csv"), rules_of(STUDIES[root], name)
    if STUDIES[root].settings == "shipped" and (ROOT / shipped).exists():
        found = searched_for(ROOT / shipped)
        if found.learner == wanted and found.searches >= searches(STUDIES[root], name):
            return shipped.as_posix()
    return f"{root}/search/{name}.csv"


rule search:
    input:
        scenario=own_scenario,
    output:
        "{root}/chunks/search/{training}.{chunk}.csv",
    log:
        "{root}/logs/search/{training}.{chunk}.log",
    benchmark:
        "{root}/logs/search/{training}.{chunk}.tsv"
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=30),
    params:
        **calls("replication.training.trials.search_for"),
        arguments=lambda w: as_text(
            training=w.training,
            learner=rules_of(study(w), w.training),
            budget=budget(study(w)),
            **bounds(
                w.chunk, searches(study(w), w.training), searches_per_job(study(w), w.training)
            ),
            tests=study(w).training.tests,
        ),
    message:
        "Search for {wildcards.training}, chunk {wildcards.chunk} of its searches"
    script:
        "../scripts/call.py"


def search_chunks(wildcards):
    its, name = study(wildcards), wildcards.training
    return chunks(searches(its, name), searches_per_job(its, name))


rule search_sample:
    input:
        trials=lambda w: expand(
            "{root}/chunks/search/{training}.{chunk}.csv", chunk=search_chunks(w), **w
        ),
    output:
        "{root}/search/{training}.csv",
    log:
        "{root}/logs/search_sample/{training}.log",
    localrule: True
    params:
        **calls("replication.training.samples.put_together"),
        arguments=lambda w: as_text(sought=sought(study(w), w.training)),
    message:
        "Keep all trials of the searches for {wildcards.training}"
    script:
        "../scripts/call.py"


rule tune:
    input:
        lambda w: [f"{MAIN}/search/{name}.csv" for name in TRAININGS[MAIN].tuned()],
    message:
        "All widths and rates are searched for: see {input[0]} and its neighbours"
