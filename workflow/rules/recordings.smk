"""Recordings of the arm before and after recalibration, for the rerun viewer."""

@cache
def recording_of(root, recording):
    """What is recorded: asked once, since it knows what stands in the meshes that are drawn."""
    return PLANS[root].recording(recording)


def recorded(wildcards):
    return recording_of(wildcards.root, wildcards.recording)


def samples_of_recorded(wildcards):
    return [sample(wildcards, name) for name in recorded(wildcards).papers()]


rule recording:
    input:
        scenario=lambda w: layout(w).scenario(recorded(w).scenario),
        samples=samples_of_recorded,
        histories=lambda w: [
            layout(w).history(recorded(w).scenario, name) for name in recorded(w).papers()
        ],
    output:
        LAYOUT.recording("{recording}"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=10),
    params:
        code=made_from("record.py", reads=samples_of_recorded),
        job=lambda w: as_text(recorded(w)),
    message:
        "Record {wildcards.recording}"
    script:
        "../scripts/record.py"


def recordings_of(root):
    """The recordings of a study, if it has learners that are recorded."""
    names = PLANS[root].recordings()
    return [Layout(root).recording(name) for name in names]


def pictured(wildcards):
    """The recording that pictures are taken of; called `arm`, those of the study's own scenario."""
    its = wildcards.recording
    return layout(wildcards).recording(study(wildcards).scenario if its == "arm" else its)


rule before_and_after:
    input:
        recording=pictured,
    output:
        before=report(
            LAYOUT.figure("{recording}_before", ".png"),
            caption="../report/pictures.rst",
            category="Pictures",
            labels={"picture": "1: before recalibration"},
        ),
        after=report(
            LAYOUT.figure("{recording}_after", ".png"),
            caption="../report/pictures.rst",
            category="Pictures",
            labels={"picture": "2: after recalibration"},
        ),
    localrule: True
    params:
        code=made_from("pictures.py"),
    message:
        "Take pictures of the arm with the viewer, which needs a Vulkan driver"
    script:
        "../scripts/pictures.py"


rule film:
    input:
        recording=pictured,
    output:
        LAYOUT.figure("{recording}", ".webp"),
    localrule: True
    params:
        code=made_from("film.py"),
    message:
        "Film the arm with the viewer, which needs a Vulkan driver: minutes, where that is software"
    script:
        "../scripts/film.py"


PICTURES = "arm_before.png", "arm_after.png", "arm.webp"


rule pictures:
    input:
        [f"figures/{picture}" for picture in PICTURES]
        if MAIN == RESULTS
        else [Layout(MAIN).figure(picture, "") for picture in PICTURES],
    message:
        "The arm before and after: {input}"
