"""Recordings of the arm before and after recalibration, for the rerun viewer."""


RECORDED = ["improved", "ritter_200"]  # side by side; the arm follows the first


rule recording:
    input:
        code=code("record.py"),
        scenario=rules.scenario.output[0],
    output:
        f"{RESULTS}/recordings/{{scenario}}.rrd",
    params:
        learners=RECORDED,
        settings=lambda w: [entry_of(learner) for learner in RECORDED],
        training=EVALUATION,
        seed=config["seed"],
    message:
        "Record the arm on {wildcards.scenario}"
    script:
        "../scripts/record.py"


RECORDINGS = expand(rules.recording.output, scenario=SCENARIOS)


rule pictures:
    input:
        code=code("pictures.py"),
        recording=rules.recording.output[0].format(scenario=PAPER),
    output:
        before=report(
            f"{FIGURE_FOLDER}/arm_before.png",
            caption="../report/pictures.rst",
            category="Pictures",
            labels={"picture": "Before: the arm misses"},
        ),
        after=report(
            f"{FIGURE_FOLDER}/arm_after.png",
            caption="../report/pictures.rst",
            category="Pictures",
            labels={"picture": "After: the arm hits"},
        ),
    message:
        "Take pictures of the arm with the viewer, which needs a Vulkan driver"
    script:
        "../scripts/pictures.py"
