"""The check of the final error values."""


rule check:
    input:
        summary=LAYOUT.summary,
        expected=lambda w: study(w).expected,
    output:
        LAYOUT.check,
    localrule: True
    params:
        code=made_from("check.py", reads=lambda w: [study(w).expected]),
    message:
        "Check the final errors against {input.expected}"
    script:
        "../scripts/check.py"


rule expect:
    input:
        summary=LAYOUT.summary,
    output:
        LAYOUT.expected,
    localrule: True
    params:
        code=made_from("expect.py"),
    message:
        "Propose new bands for the check"
    script:
        "../scripts/expect.py"
