"""Recordings of the arm before and after recalibration, for the rerun viewer."""

from replication.config.switches import IMPROVED
from replication.training.competitors import homes_of
from replication.training.recordings import recording as what_is_recorded


@cache
def recording_of(root, recording):
    """What is recorded: asked once, since it knows what stands in the meshes that are drawn."""
    return what_is_recorded(STUDIES[root], recording)


def recorded(wildcards):
    return recording_of(wildcards.root, wildcards.recording)


def samples_of_recorded(wildcards):
    return [sample(wildcards, name) for name in recorded(wildcards).papers()]


TEXTS_OF_RECORDINGS = expand("workflow/recording/{text}.md.j2", text=["about", "beside"])


rule recording:
    input:
        scenario=lambda w: f"{w.root}/scenarios/{recorded(w).scenario}.json",
        samples=samples_of_recorded,
        histories=lambda w: [
            f"{w.root}/runs/{recorded(w).scenario}/{name}.parquet" for name in recorded(w).papers()
        ],
        texts=TEXTS_OF_RECORDINGS,
    output:
        rrd="{root}/recordings/{recording}.rrd",
    log:
        "{root}/logs/recording/{recording}.log",
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=10),
    params:
        **calls(
            "replication.recording.writing.record",
            also=lambda w: homes_of(recorded(w).learners),
            reads=lambda w: [*samples_of_recorded(w), *TEXTS_OF_RECORDINGS],
        ),
        arguments=lambda w: as_text(recording=recorded(w)),
    message:
        "Record {wildcards.recording}"
    script:
        "../scripts/call.py"


def recordings_of(root):
    """The recordings of a study."""
    return [f"{root}/recordings/{name}.rrd" for name in STUDIES[root].experiments.scenarios]


rule in_browser:
    input:
        scenario=own_scenario,
        sample=lambda w: sample(w, IMPROVED),
        history=lambda w: f"{w.root}/runs/{study(w).scenario}/{TRAININGS[w.root].name(IMPROVED)}.parquet",
    output:
        "{root}/pages/study.js",
    log:
        "{root}/logs/in_browser.log",
    localrule: True
    params:
        **calls(
            "replication.recording.in_browser.script",
            reads=lambda w: [sample(w, IMPROVED)],
        ),
        arguments=lambda w: as_text(
            learner=rules_of(study(w), IMPROVED),
            measuring=measuring(study(w)),
            seed=study(w).seed,
        ),
    message:
        "Write what a browser needs to repeat the recorded run"
    script:
        "../scripts/call.py"


def pictured(wildcards):
    """The recording that pictures are taken of; called `arm`, those of the study's own scenario."""
    its = wildcards.recording
    its = study(wildcards).scenario if its == "arm" else its
    return f"{wildcards.root}/recordings/{its}.rrd"


rule before_and_after:
    input:
        recording=pictured,
    output:
        before=report(
            "{root}/figures/{recording}_before.png",
            caption="../report/pictures.rst",
            category="Pictures",
            labels={"page": "1: before recalibration"},
        ),
        after=report(
            "{root}/figures/{recording}_after.png",
            caption="../report/pictures.rst",
            category="Pictures",
            labels={"page": "2: after recalibration"},
        ),
    log:
        "{root}/logs/before_and_after/{recording}.log",
    localrule: True
    params:
        **calls("replication.recording.pictures.before_and_after"),
    message:
        "Take pictures of the arm with the viewer, which needs a Vulkan driver"
    script:
        "../scripts/call.py"


rule film:
    input:
        recording=pictured,
    output:
        film="{root}/figures/{recording}.webp",
    log:
        "{root}/logs/film/{recording}.log",
    localrule: True
    params:
        **calls("replication.recording.pictures.take_film"),
    message:
        "Film the arm with the viewer, which needs a Vulkan driver: minutes, where that is software"
    script:
        "../scripts/call.py"


PICTURES = "arm_before.png", "arm_after.png", "arm.webp"


rule pictures:
    input:
        expand(
            "{folder}/{picture}",
            folder="figures" if MAIN == RESULTS else f"{MAIN}/figures",
            picture=PICTURES,
        ),
    message:
        "The arm before and after: {input}"
