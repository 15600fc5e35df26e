"""Train every learner on its scenarios, in chunks of seeds."""

TRAINING = config["training"]


EVALUATION = {key: value for key, value in TRAINING.items() if key.startswith(("tests", "measure"))}


def entry_of(learner):
    """All that a learner's training depends on: its rules, its iterations and the settings found for them."""
    which = tuned.training(learner, config["learners"])
    rules_, settings = config["learners"][which.name], tuned.settings(which, config["tuned"])
    return {**rules_, "iterations": which.iterations, "settings": settings}


def seeds_of(learner):
    """How many seeds a learner is trained with."""
    iterations = tuned.training(learner, config["learners"]).iterations
    return TRAINING["seeds" if iterations <= TRAINING["short"] else "seeds_long"]


rule train:
    input:
        code=code("train.py"),
        scenario=rules.scenario.output[0],
    output:
        history=f"{RESULTS}/chunks/{{scenario}}/{{learner}}.{{chunk}}.parquet",
        learned=f"{RESULTS}/chunks/{{scenario}}/{{learner}}.{{chunk}}.npz",
    params:
        seeds=lambda w: bounds(w.chunk, seeds_of(w.learner), TRAINING["seeds_per_job"]),
        learner=lambda w: entry_of(w.learner),
        training=EVALUATION,
        throughout=lambda w: w.scenario in SCENARIOS and w.learner in EXPERIMENTS["learners"],
        seed=config["seed"],
    priority: 10
    message:
        "Train seeds {params.seeds[0]} to {params.seeds[1]} of {wildcards.learner} on {wildcards.scenario}"
    script:
        "../scripts/train.py"


def chunks_of(kind):
    def of(wildcards):
        return [
            getattr(rules.train.output, kind).format(**wildcards, chunk=chunk)
            for chunk in chunks(seeds_of(wildcards.learner), TRAINING["seeds_per_job"])
        ]

    return of


rule run:
    input:
        code=code("gather.py"),
        histories=chunks_of("history"),
        learned=chunks_of("learned"),
    output:
        history=f"{RESULTS}/runs/{{scenario}}/{{learner}}.parquet",
        learned=f"{RESULTS}/runs/{{scenario}}/{{learner}}.npz",
    message:
        "Put the seeds of {wildcards.learner} on {wildcards.scenario} together"
    script:
        "../scripts/gather.py"


def histories(runs):
    """The histories of trainings, each a scenario and a learner."""
    return [rules.run.output.history.format(scenario=scenario, learner=learner) for scenario, learner in runs]
