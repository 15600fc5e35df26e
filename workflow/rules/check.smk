"""The check of the final error values."""


rule check:
    input:
        summary=LAYOUT.summary,
        expected=lambda w: study(w).expected,
    output:
        LAYOUT.check,
    params:
        code=made_from("check.py", reads=lambda w: [study(w).expected]),
    localrule: True
    message:
        "Check the final errors against {input.expected}"
    script:
        "../scripts/check.py"


rule expect:
    input:
        summary=LAYOUT.summary,
    output:
        LAYOUT.expected,
    params:
        code=made_from("expect.py"),
    localrule: True
    message:
        "Propose new bands for the check"
    script:
        "../scripts/expect.py"
