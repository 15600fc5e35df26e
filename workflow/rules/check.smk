"""The check of the final error values, and the benchmark."""

rule check:
    input:
        code=code("check.py"),
        summary=rules.summary.output[0],
        expected=config["expected"],
    output:
        f"{RESULTS}/check.txt",
    message:
        "Check the final errors against {input.expected}"
    script:
        "../scripts/check.py"


rule expect:
    input:
        code=code("expect.py"),
        summary=rules.summary.output[0],
    output:
        f"{RESULTS}/expected.csv",
    message:
        "Propose new bands for the check"
    script:
        "../scripts/expect.py"


rule bench:
    input:
        code=code("bench.py"),
        scenario=rules.scenario.output[0].format(scenario=PAPER),
    output:
        f"{RESULTS}/bench.txt",
    message:
        "Measure the speed of moves and trainings"
    script:
        "../scripts/bench.py"
