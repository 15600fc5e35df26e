"""The check of the final error values."""


rule check:
    input:
        code=code("check.py"),
        summary=LAYOUT.summary,
        expected=lambda w: study(w).expected,
    output:
        LAYOUT.check,
    message:
        "Check the final errors against {input.expected}"
    script:
        "../scripts/check.py"


rule expect:
    input:
        code=code("expect.py"),
        summary=LAYOUT.summary,
    output:
        LAYOUT.expected,
    message:
        "Propose new bands for the check"
    script:
        "../scripts/expect.py"
