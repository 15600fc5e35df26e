"""Which damage, on which robot."""

from recalib.study.configuration.damages import Assigned
from recalib.study.trainings import scenario_of


rule assignments:
    output:
        table=LAYOUT.assignments("{robot}"),
        assignment=LAYOUT.assignments("{robot}", ".json"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=10),
    params:
        code=made_from("assign.py"),
        job=lambda w: as_text(plan(w).assignments(w.robot)),
    message:
        "Try every assignment of the paper's damage to the robot {wildcards.robot}"
    script:
        "../scripts/assign.py"


def assignment(wildcards):
    """The assignment of the paper's damage, for a scenario that has a part of it."""
    name, robot = scenario_of(study(wildcards), wildcards.scenario)
    assigned = any(isinstance(entry, Assigned) for entry in study(wildcards).scenarios[name])
    return [layout(wildcards).assignments(robot, ".json")] if assigned else []


rule scenario:
    input:
        assignment=assignment,
    output:
        LAYOUT.scenario("{scenario}"),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=10),
    params:
        code=made_from("scenario.py"),
        job=lambda w: as_text(plan(w).scenario(w.scenario)),
    message:
        "Resolve the damage of {wildcards.scenario} and measure its initial errors"
    script:
        "../scripts/scenario.py"


def own_scenario(wildcards):
    """The paper's damage, as resolved in this study."""
    return layout(wildcards).scenario(study(wildcards).scenario)
