"""Train every learner on its scenarios, in chunks of seeds."""


rule train:
    input:
        scenario=LAYOUT.scenario("{scenario}"),
        sample=lambda w: sample(w, w.learner),
    output:
        history=LAYOUT.chunk("{scenario}", "{learner}", "{chunk}"),
        learned=LAYOUT.chunk("{scenario}", "{learner}", "{chunk}", ".npz"),
    priority: 10
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        code=made_from("train.py", reads=lambda w: [sample(w, w.learner)]),
        job=lambda w: as_text(plan(w).training(w.scenario, w.learner, int(w.chunk))),
    message:
        "Train {wildcards.learner} on {wildcards.scenario}, chunk {wildcards.chunk} of its seeds"
    script:
        "../scripts/train.py"


def training_chunks(suffix):
    def of(wildcards):
        numbers = plan(wildcards).training_chunks(wildcards.learner)
        where = wildcards.scenario, wildcards.learner
        return [layout(wildcards).chunk(*where, number, suffix) for number in numbers]

    return of


rule run:
    input:
        histories=training_chunks(".parquet"),
        learned=training_chunks(".npz"),
    output:
        history=LAYOUT.history("{scenario}", "{learner}"),
        learned=LAYOUT.learned("{scenario}", "{learner}"),
    localrule: True
    params:
        code=made_from("gather.py"),
    message:
        "Put the seeds of {wildcards.learner} on {wildcards.scenario} together"
    script:
        "../scripts/gather.py"


rule ensemble_chunk:
    input:
        sample=lambda w: sample(w, w.learner),
    output:
        LAYOUT.ensemble_chunk("{series}", "{learner}", "{chunk}"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        code=made_from("ensemble.py", reads=lambda w: [sample(w, w.learner)]),
        job=lambda w: as_text(plan(w).draws(w.series, w.learner, int(w.chunk))),
    message:
        "Train {wildcards.learner} on other damages: {wildcards.series}, chunk {wildcards.chunk}"
    script:
        "../scripts/ensemble.py"


rule ensemble:
    input:
        chunks=lambda w: [
            layout(w).ensemble_chunk(w.series, w.learner, chunk)
            for chunk in plan(w).draw_chunks(w.series, w.learner)
        ],
    output:
        LAYOUT.ensemble("{series}", "{learner}"),
    localrule: True
    params:
        code=made_from("concat.py"),
    message:
        "Put the other damages for {wildcards.learner} together: {wildcards.series}"
    script:
        "../scripts/concat.py"


rule bench:
    input:
        scenario=own_scenario,
        samples=lambda w: [sample(w, learner) for learner in MEASURED],
    output:
        LAYOUT.bench,
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        code=made_from("bench.py", reads=lambda w: [sample(w, name) for name in MEASURED]),
        job=lambda w: as_text(plan(w).speed(MEASURED)),
    message:
        "Measure the speed of moves and trainings"
    script:
        "../scripts/bench.py"


MEASURED = ["improved", "ritter"]
