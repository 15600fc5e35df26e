"""Figures, recordings and pages, and the publication of those of the shipped study."""

from recalib.nominal.descriptions import find_urdf
from recalib.nominal.meshes import mesh_files
from replication.config.shipped import DEVIATIONS
from replication.config.switches import IMPROVED
from replication.pages.names import OUTCOME, pages_of
from replication.plots.figures import Figure, figures_of
from replication.recording.recorded import recorded_places
from replication.training.plan import leading

FIGURES = [
    f"{RESULTS}/figures/{name}.{suffix}" for name in figures_of(STUDY) for suffix in ("svg", "png")
]
PAGES = [f"{RESULTS}/pages/{page}" for page in pages_of(STUDY)]
RECORDINGS = [f"{RESULTS}/recordings/{place.scenario}.rrd" for place in recorded_places(STUDY)]
FINDINGS = f"{RESULTS}/claims.json"
CHECK = [f"{RESULTS}/check.txt"] if STUDY.expected else []
# Other inputs of pages. Paths are relative, so a project that was moved does not run again.
QUOTED = ["pyproject.toml", *map(os.path.relpath, sorted(ROOT.glob("workflow/templates/*")))]
QUOTED += ["CITATION.cff", "config.yaml", DEVIATIONS] * IS_SHIPPED


rule figures:
    input:
        EVIDENCE,
        findings=FINDINGS,
    output:
        figures=FIGURES,
    log:
        f"{RESULTS}/logs/figures.log",
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        **calls("plots.rendering:draw"),
    message:
        "Draw the figures"
    script:
        "../scripts/call.py"


rule recordings:
    input:
        scenarios=[place.scenario_file(RESULTS) for place in recorded_places(STUDY)],
        settings=SETTINGS,
        meshes=[str(path) for path in mesh_files(find_urdf(STUDY.robots[STUDY.robot].urdf))],
        histories=[
            place.history_file(RESULTS, leading(STUDY).learner) for place in recorded_places(STUDY)
        ],
    output:
        recordings=RECORDINGS,
    log:
        f"{RESULTS}/logs/recordings.log",
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        **calls("recording.recordings:record"),
    message:
        "Record the arm before and after recalibration"
    script:
        "../scripts/call.py"


rule pages:
    input:
        EVIDENCE,
        FINDINGS,
        QUOTED,
        figures=FIGURES,
    output:
        pages=PAGES,
    log:
        f"{RESULTS}/logs/pages.log",
    localrule: True
    params:
        **calls("pages.writing:write"),
    message:
        "Write the pages"
    script:
        "../scripts/call.py"


rule in_browser:
    input:
        scenario=OWN.scenario_file(RESULTS),
        settings=SETTINGS,
        history=OWN.history_file(RESULTS, IMPROVED),
    output:
        f"{RESULTS}/pages/study.js",
    log:
        f"{RESULTS}/logs/in_browser.log",
    localrule: True
    params:
        **calls("recording.in_browser:script"),
    message:
        "Write the data with which a browser repeats the recorded run"
    script:
        "../scripts/call.py"


def committed(path):
    """The committed path of a file of the shipped study."""
    name = Path(path).name
    if path in FIGURES:
        return f"figures/{name}"
    return name if name == "README.md" else f"docs/{name}"


PUBLISHED = [
    *FIGURES,
    *(page for page in PAGES if page.endswith(".md")),
    f"{RESULTS}/pages/study.js",
]


# Copies are a rule of their own: if drawing fails, the committed file remains.
rule publish:
    input:
        sources=PUBLISHED,
    output:
        copies=[committed(path) for path in PUBLISHED],
    log:
        f"{RESULTS}/logs/publish.log",
    localrule: True
    params:
        **calls("pages.writing:publish"),
    message:
        "Publish figures and pages"
    script:
        "../scripts/call.py"


EVERYTHING = [f"{RESULTS}/summary.csv", FINDINGS, *CHECK, *FIGURES, *RECORDINGS, *PAGES]
if IS_SHIPPED:
    EVERYTHING += [committed(path) for path in PUBLISHED]


# Targets outside the default run, with their tables, figure and page.
APART = {
    "benchmark": (
        ["benchmark.csv", "benchmark_moves.csv"],
        Figure.BENCHMARK,
        "guidance.md",
    ),
    "real": (["real.csv"], Figure.REAL_ARM, "real_arm.md"),
}

for part, (tables, figure, page) in APART.items():
    made = [f"{RESULTS}/figures/{figure.file}.{suffix}" for suffix in ("svg", "png")]

    rule:
        name:
            f"{part}_figure"
        input:
            tables=[f"{RESULTS}/{table}" for table in tables],
        output:
            figures=made,
        log:
            f"{RESULTS}/logs/{part}_figure.log",
        localrule: True
        params:
            **calls("plots.rendering:draw"),
        message:
            f"Draw the {part}"
        script:
            "../scripts/call.py"

    rule:
        name:
            f"{part}_page"
        input:
            QUOTED,
            tables=[f"{RESULTS}/{table}" for table in tables],
            figures=made,
        output:
            pages=[f"{RESULTS}/pages/{page}"],
        log:
            f"{RESULTS}/logs/{part}_page.log",
        localrule: True
        params:
            **calls("pages.writing:write"),
        message:
            f"Write the page of the {part}"
        script:
            "../scripts/call.py"

    rule:
        name:
            f"publish_{part}"
        input:
            sources=[*made, f"{RESULTS}/pages/{page}"],
        output:
            copies=[f"figures/{Path(path).name}" for path in made] + [f"docs/{page}"],
        log:
            f"{RESULTS}/logs/publish_{part}.log",
        localrule: True
        params:
            **calls("pages.writing:publish"),
        message:
            f"Publish the {part}"
        script:
            "../scripts/call.py"

    rule:
        name:
            part
        input:
            (
                [f"figures/{Path(path).name}" for path in made] + [f"docs/{page}"]
                if IS_SHIPPED
                else [*made, f"{RESULTS}/pages/{page}"]
            ),
        message:
            f"The results are in {RESULTS}"


rule article:
    input:
        source=f"{RESULTS}/pages/article.typ",
        references="workflow/article/references.bib",
        # without the benchmark's figure, which takes minutes: the article uses the committed one
        figures=[*FIGURES, "figures/method.svg"],
    output:
        article=f"{RESULTS}/article.pdf",
    log:
        f"{RESULTS}/logs/article.log",
    localrule: True
    params:
        **calls("pages.article:typeset"),
    message:
        "Typeset the article"
    script:
        "../scripts/call.py"


rule film:
    input:
        recording=f"{RESULTS}/recordings/{{scenario}}.rrd",
    output:
        film=f"{RESULTS}/figures/{{scenario}}.webp",
    log:
        f"{RESULTS}/logs/film/{{scenario}}.log",
    localrule: True
    params:
        **calls("recording.film:take_film"),
    message:
        "Film the arm with the viewer, which needs a Vulkan driver (minutes with a software driver)"
    script:
        "../scripts/call.py"


onsuccess:
    if any(job.rule.name == "pages" for job in workflow.dag.jobs):
        print(Path(f"{RESULTS}/pages/{OUTCOME}").read_text(encoding="utf-8"))
