"""Scenarios, settings, trainings, and measurements of the mapping."""

from recalib.nominal.descriptions import find_urdf
from replication.config.shipped import OUTCOMES
from replication.training.plan import Place, places
from replication.training.tuned import untuned

PLACES = places(STUDY)
OWN = Place(STUDY.robot, STUDY.scenario)
SETTINGS = [OUTCOMES] + [f"{RESULTS}/settings/{learner}.csv" for learner in untuned(STUDY, ROOT)]


wildcard_constraints:
    robot=r"\w+",
    scenario=r"\w+",
    learner=r"\w+",


rule scenarios:
    input:
        [
            str(find_urdf(STUDY.robots[robot].urdf))
            for robot in dict.fromkeys(place.robot for place in PLACES)
        ],
    output:
        resolved=[place.scenario_file(RESULTS) for place in PLACES],
        assignments=f"{RESULTS}/assignments/{STUDY.robot}.parquet",
    log:
        f"{RESULTS}/logs/scenarios.log",
    resources:
        **room(mem_mb=2000, runtime=10),
    params:
        **calls("training.train:write_scenarios"),
    message:
        "Apply the damages to the robots"
    script:
        "../scripts/call.py"


rule settings:
    input:
        scenario=OWN.scenario_file(RESULTS),
    output:
        f"{RESULTS}/settings/{{learner}}.csv",
    log:
        f"{RESULTS}/logs/settings/{{learner}}.log",
    resources:
        **room(mem_mb=2000, runtime=60),
    params:
        **calls("campaign.own:tune"),
        learner=lambda w: w.learner,
    message:
        "Search for the widths and rates of {wildcards.learner}"
    script:
        "../scripts/call.py"


# One rule for each place, because each has its own learners.
for place in PLACES:

    rule:
        name:
            f"train_{place.robot}_{place.scenario}"
        input:
            resolved=place.scenario_file(RESULTS),
            settings=SETTINGS,
        output:
            histories=[place.history_file(RESULTS, learner) for learner in PLACES[place]],
            learned=[place.learned_file(RESULTS, learner) for learner in PLACES[place]],
        log:
            f"{RESULTS}/logs/train/{place.robot}.{place.scenario}.log",
        priority: 10
        group:
            "trainings"
        resources:
            **room(mem_mb=2000, runtime=60),
        params:
            **calls("training.train:train"),
            robot=place.robot,
            scenario=place.scenario,
        message:
            f"Train on the {place.robot}: {place.scenario}"
        script:
            "../scripts/call.py"


rule ensemble:
    input:
        settings=SETTINGS,
    output:
        f"{RESULTS}/ensemble.parquet",
    log:
        f"{RESULTS}/logs/ensemble.log",
    resources:
        **room(mem_mb=2000, runtime=60),
    params:
        **calls("training.ensemble:train_ensemble"),
    message:
        "Train on other assignments of the damage"
    script:
        "../scripts/call.py"


rule mapping:
    input:
        scenarios=[place.scenario_file(RESULTS) for place in PLACES if place.robot == STUDY.robot],
        own=OWN.scenario_file(RESULTS),
    output:
        coupling=f"{RESULTS}/mapping/coupling.parquet",
        nearness=f"{RESULTS}/mapping/nearness.parquet",
        propagation=f"{RESULTS}/mapping/propagation.parquet",
        quantisation=f"{RESULTS}/mapping/quantisation.parquet",
        solutions=f"{RESULTS}/mapping/solutions.parquet",
        visits=f"{RESULTS}/mapping/visits.parquet",
    log:
        f"{RESULTS}/logs/mapping.log",
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        **calls("mapping.jobs:measure"),
    message:
        "Measure the true mapping"
    script:
        "../scripts/call.py"


rule learning:
    input:
        own=OWN.scenario_file(RESULTS),
        settings=SETTINGS,
    output:
        replay=f"{RESULTS}/mapping/replay.parquet",
        widths=f"{RESULTS}/mapping/widths.parquet",
    log:
        f"{RESULTS}/logs/learning.log",
    resources:
        **room(mem_mb=2000, runtime=20),
    params:
        **calls("mapping.jobs:learn"),
    message:
        "Learn from a table, and with constant widths"
    script:
        "../scripts/call.py"


# Tables for claims, figures and pages.
TABLES = [*rules.ensemble.output, *rules.mapping.output, *rules.learning.output]
