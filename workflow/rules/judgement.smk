"""A table of final errors from all histories, its check, and a finding for each claim."""

from replication.config.shipped import DESIGN, HALFWAY, OUTCOMES, UNTRAINED

TRAININGS = {
    "resolved": [place.scenario_file(RESULTS) for place in PLACES],
    "histories": [
        place.history_file(RESULTS, learner)
        for place, learners in PLACES.items()
        for learner in learners
    ],
}
EVIDENCE = [f"{RESULTS}/summary.csv", *TRAININGS["resolved"], *TRAININGS["histories"]]
EVIDENCE += TABLES * STUDY.experiments.evidence
EVIDENCE += [DESIGN, OUTCOMES, UNTRAINED, HALFWAY] * IS_SHIPPED


rule summary:
    input:
        **TRAININGS,
    output:
        f"{RESULTS}/summary.csv",
    log:
        f"{RESULTS}/logs/summary.log",
    localrule: True
    params:
        **calls("judgement.error_tables:summarise"),
        digits=6,
    message:
        "Collect the final errors of all trainings"
    script:
        "../scripts/call.py"


rule findings:
    input:
        EVIDENCE,
    output:
        f"{RESULTS}/claims.json",
    log:
        f"{RESULTS}/logs/findings.log",
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        **calls("judgement.claims:findings_of"),
    message:
        "Judge every claim of the paper"
    script:
        "../scripts/call.py"


rule check:
    input:
        summary=f"{RESULTS}/summary.csv",
        expected=STUDY.expected or [],
    output:
        f"{RESULTS}/check.txt",
    log:
        f"{RESULTS}/logs/check.log",
    localrule: True
    params:
        **calls("judgement.checks:report"),
    message:
        "Check the final errors against their bands"
    script:
        "../scripts/call.py"


rule expect:
    input:
        summary=f"{RESULTS}/summary.csv",
    output:
        f"{RESULTS}/expected.csv",
    log:
        f"{RESULTS}/logs/expect.log",
    localrule: True
    params:
        **calls("judgement.checks:propose"),
        digits=4,
    message:
        "Propose new bands for the check"
    script:
        "../scripts/call.py"
