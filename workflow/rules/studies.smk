"""What a study consists of, a target for each of them, and what the shipped one publishes."""

from snakemake.exceptions import WorkflowError

from workflow.alone import check_known, check_writable, hold

try:
    check_writable(".snakemake")
    check_known(STUDIES)
except RecalibError as error:
    sys.exit(str(error))


def folder_of(job):
    """The folder of results that a job writes into; the shipped one's for what is published."""
    roots = sorted(STUDIES, key=len, reverse=True)
    inside = (root for root in roots for path in job.output if path.startswith(f"{root}/"))
    return next(inside, RESULTS)


onstart:
    jobs = list(workflow.dag.needrun_jobs())
    try:
        hold({folder_of(job) for job in jobs if job.output})
    except RecalibError as error:
        raise WorkflowError(str(error)) from None
    planned = [job.wildcards for job in jobs if job.rule.name == "scenario"]
    for root, study_ in STUDIES.items():
        asked_before = TRAININGS[root].scenarios() if root == MAIN else ()
        others = {its.scenario for its in planned if its.root == root}.difference(asked_before)
        if others and (mistakes := ask_robots(study_, sorted(others))):
            raise WorkflowError("\n".join(map(str, mistakes)))


onsuccess:
    for job in workflow.dag.jobs:
        if job.rule.name == "outcome":
            print(Path(job.output[0]).read_text(encoding="utf-8"))


def everything(root):
    """All results of a study, and what is made of them."""
    wanted = [f"{root}/{name}" for name in ("summary.csv", "claims.json", "outcome.txt")]
    wanted += [f"{root}/runs/{on}/{learner}.npz" for on, learner in TRAININGS[root].runs]
    if STUDIES[root].expected:
        wanted.append(f"{root}/check.txt")
    if STUDIES[root].experiments.evidence:
        wanted += with_copies(root, pages=PAGES_BY_DEFAULT)
    if root == RESULTS:
        wanted += with_copies(root, pages=PAGES_OF_THE_SHIPPED)
    drawn_ = dict.fromkeys([*(Path(path).stem for path in figures_of(root)), *ideas_of(root)])
    return [*wanted, *with_copies(root, figures=drawn_), *recordings_of(root), *report_of(root)]


COPIES = {
    page if page == "README.md" else f"docs/{page}": page
    for page in [*PAGES_OF_EVIDENCE, "study.js"]
}


def with_copies(root, figures=(), pages=()):
    """Figures and pages of a study; of the shipped one, their committed copies, too."""
    drawings = [f"figures/{name}.{suffix}" for name in figures for suffix in ("svg", "png")]
    made = [f"{root}/{path}" for path in drawings] + [f"{root}/pages/{page}" for page in pages]
    if root == RESULTS:
        made += drawings
        made += [copy for copy, page in COPIES.items() if page in pages]
    return made


# A copy takes no time: whatever becomes of a drawing, the committed file is there.
rule publish_figure:
    input:
        f"{RESULTS}/figures/{{figure}}.{{suffix}}",
    output:
        "figures/{figure}.{suffix}",
    log:
        f"{RESULTS}/logs/publish_figure/{{figure}}.{{suffix}}.log",
    wildcard_constraints:
        figure="|".join([*FIGURES, "arm", "arm_before", "arm_after"]),
        suffix="svg|png|webp",
    localrule: True
    message:
        "Publish {output}"
    shell:
        "cp {input} {output} 2> {log}"


rule publish_page:
    input:
        lambda w: f"{RESULTS}/pages/{COPIES[w.page]}",
    output:
        "{page}",
    log:
        f"{RESULTS}/logs/publish_page/{{page}}.log",
    wildcard_constraints:
        page="|".join(COPIES),
    localrule: True
    message:
        "Publish {output}"
    shell:
        "cp {input} {output} 2> {log}"


rule benchmark:
    input:
        lambda w: with_copies(MAIN, figures=["figure12"], pages=["guidance.md"]),
    message:
        "What one should use today: {input}"


rule real:
    input:
        f"{MAIN}/real.csv",
        lambda w: with_copies(MAIN, figures=["figure13"], pages=["real_arm.md"]),
    message:
        "The real arm: {input}"


for root_ in STUDIES:
    if root_ != MAIN:

        rule:
            name:
                STUDIES[root_].name
            input:
                lambda w, root=root_: everything(root),
            message:
                f"All results are in {root_}"
