"""The rough searches for widths and rates: no part of a run that finds its samples in workflow/search."""

from functools import cache

from recalib.study.trainings import rules as rules_of, training


def sample(wildcards, learner):
    """The file with the searches for a training: the shipped one, or the study's own."""
    return sample_at(wildcards.root, str(training(study(wildcards), learner)))


@cache
def sample_at(root, name):
    shipped, wanted = Path(SEARCHED, f"{name}.csv"), rules_of(STUDIES[root], name)
    if STUDIES[root].settings == "shipped" and (ROOT / shipped).exists():
        from recalib.study.experiments.samples import searched_for

        found = searched_for(ROOT / shipped)
        if found.learner == wanted and found.searches >= PLANS[root].searches(name):
            return shipped.as_posix()
    return Layout(root).searched(name)


rule search:
    input:
        scenario=own_scenario,
    output:
        LAYOUT.search_chunk("{training}", "{chunk}"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=30),
    params:
        code=made_from("search.py"),
        job=lambda w: as_text(plan(w).search(w.training, int(w.chunk))),
    message:
        "Search for {wildcards.training}, chunk {wildcards.chunk} of its searches"
    script:
        "../scripts/search.py"


rule search_sample:
    input:
        trials=lambda w: [
            layout(w).search_chunk(w.training, chunk)
            for chunk in plan(w).search_chunks(w.training)
        ],
    output:
        LAYOUT.searched("{training}"),
    localrule: True
    params:
        code=made_from("search_sample.py"),
        job=lambda w: as_text(plan(w).sample(w.training)),
    message:
        "Keep all trials of the searches for {wildcards.training}"
    script:
        "../scripts/search_sample.py"


rule tune:
    input:
        lambda w: [Layout(MAIN).searched(name) for name in TRAININGS[MAIN].tuned()],
    message:
        "All widths and rates are searched for: see {input[0]} and its neighbours"
