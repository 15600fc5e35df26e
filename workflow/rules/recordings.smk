"""Recordings of the arm before and after recalibration, for the rerun viewer."""


rule recording:
    input:
        scenario=LAYOUT.scenario("{scenario}"),
        samples=lambda w: [sample(w, learner) for learner in plan(w).recorded()],
        histories=lambda w: [
            layout(w).history(w.scenario, learner) for learner in plan(w).recorded()
        ],
    output:
        LAYOUT.recording("{scenario}"),
    params:
        code=code("record.py"),
        job=lambda w: as_text(plan(w).recording(w.scenario)),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=10),
    message:
        "Record the arm on {wildcards.scenario}"
    script:
        "../scripts/record.py"


def recordings_of(root):
    """The recordings of a study, if it has learners that are recorded."""
    scenarios = STUDIES[root].experiments.scenarios if PLANS[root].recorded() else []
    return [Layout(root).recording(scenario) for scenario in scenarios]


rule before_and_after:
    input:
        recording=lambda w: layout(w).recording(study(w).scenario),
    output:
        before=report(
            LAYOUT.figure("arm_before", ".png"),
            caption="../report/pictures.rst",
            category="Pictures",
            labels={"picture": "Before recalibration"},
        ),
        after=report(
            LAYOUT.figure("arm_after", ".png"),
            caption="../report/pictures.rst",
            category="Pictures",
            labels={"picture": "After recalibration"},
        ),
    params:
        code=code("pictures.py"),
        scenario=lambda w: study(w).scenario,
    localrule: True
    message:
        "Take pictures of the arm with the viewer, which needs a Vulkan driver"
    script:
        "../scripts/pictures.py"


rule pictures:
    input:
        ["figures/arm_before.png", "figures/arm_after.png"]
        if MAIN == RESULTS
        else [Layout(MAIN).figure(name, ".png") for name in ("arm_before", "arm_after")],
    message:
        "The arm before and after: {input}"
