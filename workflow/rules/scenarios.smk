"""Which damage, on which robot."""


rule assignments:
    input:
        code=code("assign.py"),
    output:
        table=f"{RESULTS}/assignments/{{robot}}.parquet",
        assignment=f"{RESULTS}/assignments/{{robot}}.json",
    params:
        robot=lambda w: config["robots"][w.robot],
        damage=config["paper_damage"],
        seed=config["seed"],
    message:
        "Try every assignment of the paper's damage to the robot {wildcards.robot}"
    script:
        "../scripts/assign.py"


def assignment(wildcards):
    name, robot = scenarios.robot_of(wildcards.scenario, config)
    return rules.assignments.output.assignment.format(robot=robot) if scenarios.is_assigned(config["scenarios"][name]) else []


rule scenario:
    input:
        code=code("scenario.py"),
        assignment=assignment,
    output:
        f"{RESULTS}/scenarios/{{scenario}}.json",
    params:
        damages=lambda w: config["scenarios"][scenarios.robot_of(w.scenario, config)[0]],
        robot=lambda w: config["robots"][scenarios.robot_of(w.scenario, config)[1]],
        controller=config["controller"],
        seed=config["seed"],
    message:
        "Resolve the damage of {wildcards.scenario} and measure its initial errors"
    script:
        "../scripts/scenario.py"
