"""The rough search for widths and rates: no part of a run that finds its samples in workflow/search."""

from functools import cache

from recalib.study.trainings import rules as rules_of, training


def sample(wildcards, learner):
    """The file with the search's sample for a training: the shipped one, or the study's own."""
    return sample_at(wildcards.root, str(training(study(wildcards), learner)))


@cache
def sample_at(root, name):
    shipped, wanted = Path(SEARCHED, f"{name}.csv"), rules_of(STUDIES[root], name)
    if STUDIES[root].settings == "shipped" and (ROOT / shipped).exists():
        from recalib.study.experiments.samples import searched_for

        if searched_for(ROOT / shipped).learner == wanted:
            return shipped.as_posix()
    return Layout(root).searched(name)


def trial_chunks(wildcards, rounds):
    return [
        layout(wildcards).search_chunk(wildcards.training, round_, chunk)
        for round_ in rounds
        for chunk in plan(wildcards).trial_chunks()
    ]


rule search_trials:
    input:
        scenario=own_scenario,
        earlier=lambda w: trial_chunks(w, range(1, int(w.round))),
    output:
        LAYOUT.search_chunk("{training}", "{round}", "{chunk}"),
    params:
        code=code("search_trials.py"),
        job=lambda w: as_text(plan(w).trials(w.training, int(w.round), int(w.chunk))),
    message:
        "Search for {wildcards.training}: round {wildcards.round}, chunk {wildcards.chunk}"
    script:
        "../scripts/search_trials.py"


rule search:
    input:
        trials=lambda w: trial_chunks(w, plan(w).rounds()),
    output:
        LAYOUT.searched("{training}"),
    params:
        code=code("search_sample.py"),
        job=lambda w: as_text(plan(w).sample(w.training)),
    message:
        "Keep all trials of the search for {wildcards.training}"
    script:
        "../scripts/search_sample.py"


rule tune:
    input:
        lambda w: [Layout(MAIN).searched(name) for name in TRAININGS[MAIN].tuned()],
    message:
        "All widths and rates are searched for: see {input[0]} and its neighbours"
