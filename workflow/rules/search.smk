"""The rough search for widths and rates. It is no part of the default run, which uses the files that it left."""

SEARCH = config["search"]
ROUNDS = range(1, SEARCH["rounds"] + 1)
# The longest first, so that no core waits for one of them at the end.
TUNED = sorted(map(str, TRAININGS), key=lambda name: -tuned.training(name, config["learners"]).iterations)


def search_chunks(round_, learner):
    return [
        rules.search_trials.output[0].format(learner=learner, round=round_, chunk=chunk)
        for chunk in chunks(SEARCH["trials"], SEARCH["trials_per_job"])
    ]


rule search_trials:
    input:
        code=code("search_trials.py"),
        scenario=rules.scenario.output[0].format(scenario=SEARCH["scenario"]),
        earlier=lambda w: [path for round_ in range(1, int(w.round)) for path in search_chunks(round_, w.learner)],
    output:
        f"{RESULTS}/search/{{learner}}.{{round}}.{{chunk}}.csv",
    params:
        trials=lambda w: bounds(w.chunk, SEARCH["trials"], SEARCH["trials_per_job"]),
        search={key: value for key, value in SEARCH.items() if key not in ("rounds", "trials_per_job")},
        learner=lambda w: config["learners"][tuned.training(w.learner, config["learners"]).name],
        tests=TRAINING["tests"],
    message:
        "Try settings {params.trials[0]} to {params.trials[1]} of round {wildcards.round} for {wildcards.learner}"
    script:
        "../scripts/search_trials.py"


rule tune:
    input:
        [path for learner in TUNED for round_ in ROUNDS for path in search_chunks(round_, learner)],
    output:
        settings=update(f"{config['tuned']}/settings.yaml"),
        sample=update(f"{config['tuned']}/trials.csv"),
    message:
        "Keep the best settings of the search for every training"
    script:
        "../scripts/search_settings.py"
