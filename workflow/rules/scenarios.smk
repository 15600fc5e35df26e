"""Which damage, on which robot."""

from replication.config.damages import Assigned, describe
from replication.training.trainings import scenario_of


rule assignments:
    output:
        table="{root}/assignments/{robot}.parquet",
        chosen="{root}/assignments/{robot}.json",
    log:
        "{root}/logs/assignments/{robot}.log",
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=10),
    params:
        **calls("replication.scenarios.assignments.assign"),
        arguments=lambda w: as_text(
            nominal=nominal(study(w), w.robot),
            damage=study(w).paper_damage,
            seed=study(w).seed,
        ),
    message:
        "Try every assignment of the paper's damage to the robot {wildcards.robot}"
    script:
        "../scripts/call.py"


def assignment(wildcards):
    """The assignment of the paper's damage, for a scenario that has a part of it."""
    name, robot = scenario_of(study(wildcards), wildcards.scenario)
    assigned = any(isinstance(entry, Assigned) for entry in study(wildcards).scenarios[name])
    return f"{wildcards.root}/assignments/{robot}.json" if assigned else []


def damage(study, name):
    """The damages of a scenario, in the words of the configuration."""
    return [describe(entry) for entry in study.scenarios[name]]


rule scenario:
    input:
        assignment=assignment,
    output:
        "{root}/scenarios/{scenario}.json",
    log:
        "{root}/logs/scenario/{scenario}.log",
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=10),
    params:
        **calls("replication.scenarios.plants.resolve"),
        arguments=lambda w: as_text(
            name=w.scenario,
            nominal=nominal(study(w), scenario_of(study(w), w.scenario)[1]),
            damages=damage(study(w), scenario_of(study(w), w.scenario)[0]),
            poses=study(w).paper_damage.poses,
            seed=study(w).seed,
        ),
    message:
        "Resolve the damage of {wildcards.scenario} and measure its initial errors"
    script:
        "../scripts/call.py"


def own_scenario(wildcards):
    """The paper's damage, as resolved in this study."""
    return f"{wildcards.root}/scenarios/{study(wildcards).scenario}.json"
