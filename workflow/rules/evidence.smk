"""From histories to tables, verdicts and pages."""

from functools import partial

from recalib.study.evidence.claims import judging
from recalib.study.evidence.needs import Request
from recalib.study.evidence.outcome import needs as needs_of_outcome
from recalib.study.evidence.pages import PAGES as PAGES_OF_EVIDENCE


def request(root):
    """How to ask for what a claim, a figure or a page of a study reads."""
    return partial(Request, STUDIES[root], TRAININGS[root], Layout(root), partial(sample_at, root))


def asked(root, needs):
    """What something of a study reads."""
    ask = request(root)()
    needs(ask)
    return ask.needs


rule summary:
    input:
        histories=lambda w: [layout(w).history(*run) for run in TRAININGS[w.root].runs],
        scenarios=lambda w: [layout(w).scenario(name) for name in TRAININGS[w.root].scenarios()],
    output:
        LAYOUT.summary,
    localrule: True
    params:
        code=made_from("summarise.py"),
        job=lambda w: as_text(plan(w).summary()),
    message:
        "Put the final errors of every training into one table"
    script:
        "../scripts/summarise.py"


def judged_by(wildcards):
    return judging(request(wildcards.root)).inputs


rule claims:
    input:
        evidence=judged_by,
    output:
        LAYOUT.claims,
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        code=made_from("claims.py", reads=judged_by),
        job=lambda w: as_text(judging(request(w.root))),
    message:
        "Judge every claim of the paper"
    script:
        "../scripts/claims.py"


def outcome_needs(wildcards):
    return asked(wildcards.root, needs_of_outcome)


rule outcome:
    input:
        evidence=lambda w: outcome_needs(w).inputs,
    output:
        LAYOUT.outcome,
    localrule: True
    params:
        code=made_from("outcome.py", reads=lambda w: outcome_needs(w).inputs),
        job=lambda w: as_text(outcome_needs(w)),
    message:
        "Say what came out"
    script:
        "../scripts/outcome.py"


def page_needs(wildcards):
    return asked(wildcards.root, PAGES_OF_EVIDENCE[wildcards.page].needs)


rule page:
    input:
        template="workflow/templates/{page}.j2",
        evidence=lambda w: page_needs(w).inputs,
    output:
        LAYOUT.page("{page}"),
    wildcard_constraints:
        page="|".join(PAGES_OF_EVIDENCE),
    localrule: True
    params:
        code=made_from(
            "page.py", reads=lambda w: [f"workflow/templates/{w.page}.j2", *page_needs(w).inputs]
        ),
        job=lambda w: as_text(page_needs(w)),
    message:
        "Write the numbers into {wildcards.page}"
    script:
        "../scripts/page.py"
