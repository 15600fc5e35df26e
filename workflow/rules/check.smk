"""The check of the final error values."""


rule check:
    input:
        summary="{root}/summary.csv",
        expected=lambda w: study(w).expected,
    output:
        "{root}/check.txt",
    params:
        **calls("recalib.study.evidence.checks.report", reads=lambda w: [study(w).expected]),
    localrule: True
    message:
        "Check the final errors against {input.expected}"
    script:
        "../scripts/call.py"


rule expect:
    input:
        summary="{root}/summary.csv",
    output:
        "{root}/expected.csv",
    params:
        **calls("recalib.study.evidence.checks.propose"),
        digits=4,
    localrule: True
    message:
        "Propose new bands for the check"
    script:
        "../scripts/call.py"
