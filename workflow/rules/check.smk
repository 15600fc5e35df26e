"""The check of the final error values."""


rule check:
    input:
        summary="{root}/summary.csv",
        expected=lambda w: study(w).expected,
    output:
        "{root}/check.txt",
    log:
        "{root}/logs/check.log",
    localrule: True
    params:
        **calls("replication.judgement.checks.report", reads=lambda w: [study(w).expected]),
    message:
        "Check the final errors against {input.expected}"
    script:
        "../scripts/call.py"


rule expect:
    input:
        summary="{root}/summary.csv",
    output:
        "{root}/expected.csv",
    log:
        "{root}/logs/expect.log",
    localrule: True
    params:
        **calls("replication.judgement.checks.propose"),
        digits=4,
    message:
        "Propose new bands for the check"
    script:
        "../scripts/call.py"
