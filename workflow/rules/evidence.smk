"""From histories to tables, verdicts and pages."""

from functools import partial

from replication.judgement.claims import judging
from replication.judgement.needs import Request
from replication.pages.outcome import NEEDS as NEEDS_OF_OUTCOME
from replication.pages.rendering import PAGES as PAGES_OF_EVIDENCE


def request(root):
    """How to ask for what a claim, a figure or a page of a study reads."""
    return partial(Request, STUDIES[root], TRAININGS[root], root, partial(sample_at, root))


def asked(root, needs):
    """What something of a study reads."""
    return request(root)().read(needs).evidence


rule summary:
    input:
        histories=lambda w: [
            f"{w.root}/runs/{scenario}/{learner}.parquet"
            for scenario, learner in TRAININGS[w.root].runs
        ],
        scenarios=lambda w: [
            f"{w.root}/scenarios/{name}.json" for name in TRAININGS[w.root].scenarios()
        ],
    output:
        "{root}/summary.csv",
    log:
        "{root}/logs/summary.log",
    localrule: True
    params:
        **calls("replication.judgement.summary.summarise"),
        arguments=lambda w: as_text(trainings=TRAININGS[w.root].runs, seed=study(w).seed),
        digits=6,
    message:
        "Put the final errors of every training into one table"
    script:
        "../scripts/call.py"


def judged_by(wildcards):
    claims = judging(request(wildcards.root)).values()
    return sorted({path for evidence in claims for path in evidence.inputs})


rule claims:
    input:
        files=judged_by,
    output:
        "{root}/claims.json",
    log:
        "{root}/logs/claims.log",
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        **calls("replication.judgement.claims.judge", reads=judged_by),
        arguments=lambda w: as_text(claims=judging(request(w.root))),
    message:
        "Judge every claim of the paper"
    script:
        "../scripts/call.py"


def outcome_evidence(wildcards):
    return asked(wildcards.root, NEEDS_OF_OUTCOME)


rule outcome:
    input:
        files=lambda w: outcome_evidence(w).inputs,
    output:
        "{root}/outcome.txt",
    log:
        "{root}/logs/outcome.log",
    localrule: True
    params:
        **calls(
            "replication.pages.outcome.outcome",
            reads=lambda w: outcome_evidence(w).inputs,
        ),
        arguments=lambda w: as_text(evidence=outcome_evidence(w)),
    message:
        "Say what came out"
    script:
        "../scripts/call.py"


def page_evidence(wildcards):
    return asked(wildcards.root, PAGES_OF_EVIDENCE[wildcards.page].NEEDS)


rule page:
    input:
        template="workflow/templates/{page}.j2",
        files=lambda w: page_evidence(w).inputs,
    output:
        "{root}/pages/{page}",
    log:
        "{root}/logs/page/{page}.log",
    wildcard_constraints:
        page="|".join(PAGES_OF_EVIDENCE),
    localrule: True
    params:
        **calls(
            "replication.pages.rendering.page",
            reads=lambda w: [f"workflow/templates/{w.page}.j2", *page_evidence(w).inputs],
        ),
        arguments=lambda w: as_text(name=w.page, evidence=page_evidence(w)),
    message:
        "Write the numbers into {wildcards.page}"
    script:
        "../scripts/call.py"


DRAWN = ["method", "figure1", "figure4", "figure9", "figure14", "figure15"]
# other targets make them, and figures/ideas.py
COMMITTED = ["figures/figure12.svg", "figures/figure13.svg", "figures/method.svg"]


rule article:
    input:
        source=f"{RESULTS}/pages/article.typ",
        references="workflow/article/references.bib",
        figures=[f"figures/{name}.svg" for name in DRAWN],
    output:
        article=f"{RESULTS}/article.pdf",
    log:
        f"{RESULTS}/logs/article.log",
    localrule: True
    params:
        **calls(
            "replication.pages.article.typeset",
            reads=lambda w: ["workflow/article/references.bib", *COMMITTED],
        ),
    message:
        "Set the article"
    script:
        "../scripts/call.py"
