"""Validation before anything runs, and what the other stages share."""

import hashlib
import os
from functools import cache
from itertools import product
from modulefinder import ModuleFinder
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.utils import validate

validate(config, schema="../schemas/config.schema.yaml")

# A job has one core: without this, every job's linear algebra starts a thread for each core of the machine.
os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")

from recalib.study import scenarios
from recalib.errors import InvalidSetting, RecalibError
from recalib.study.evidence.claims import missing
from recalib.study.experiments import tuned
from recalib.study.experiments.benchmark import training_of

ROOT = Path(workflow.basedir)
RESULTS, FIGURE_FOLDER = config["results"], config["figures"]


@cache
def code(script):
    """The script and every module of recalib that it imports, directly or not: editing one re-runs what depends on it."""
    finder = ModuleFinder(path=[str(ROOT)])
    path = ROOT / "workflow" / "scripts" / script
    finder.run_script(str(path))
    modules = {Path(module.__file__) for module in finder.modules.values() if module.__file__}
    return sorted(str(module.relative_to(ROOT)) for module in {*modules, path})


def digest(path):
    """What a file holds, as a parameter: an input that is also the output of `tune` would start the search."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest() if Path(path).exists() else None


def chunks(total, size):
    """Names of the chunks of so many seeds or trials."""
    return range(-(-total // size))


def bounds(chunk, total, size):
    """The first and one past the last seed or trial of a chunk."""
    return [int(chunk) * size, min((int(chunk) + 1) * size, total)]


EXPERIMENTS, BENCHMARK = config["experiments"], config["benchmark"]
SCENARIOS, PAPER = EXPERIMENTS["scenarios"], config["search"]["scenario"]
RUNS = [
    *product(SCENARIOS, EXPERIMENTS["learners"]),
    *product([f"{PAPER}-{robot}" for robot in EXPERIMENTS["robots"]], EXPERIMENTS["learners"]),
    *product([PAPER], EXPERIMENTS["paper"]),
    *((PAPER, f"{learner}_{iterations}") for learner, rungs in EXPERIMENTS["ladder"].items() for iterations in rungs),
]

try:
    scenarios.check(config)
    for scenario in dict.fromkeys(scenario for scenario, _ in RUNS):
        scenarios.robot_of(scenario, config)
    for learner in EXPERIMENTS["ensemble"]:
        tuned.training(learner, config["learners"])
    for learner in BENCHMARK["learners"]:
        training_of(learner, config["learners"])
    if EXPERIMENTS["evidence"] and (lacking := missing(config)):
        raise InvalidSetting("experiments.evidence", True, f"with {', '.join(lacking)}, or false")
    # `improved` and `improved_200` may be one training: it is done once, under the shorter name.
    TRAININGS = {}
    for _, learner in RUNS:
        TRAININGS.setdefault(tuned.training(learner, config["learners"]), learner)
except RecalibError as error:
    raise WorkflowError(f"config.yaml: {error}")

RUNS = list(dict.fromkeys((scenario, TRAININGS[tuned.training(learner, config["learners"])]) for scenario, learner in RUNS))


wildcard_constraints:
    scenario=r"[\w-]+",
    robot=r"\w+",
    learner=r"\w+",
    chunk=r"\d+",
    batch=r"\d+",
    round=r"[1-9]",
    series=r"[a-z]+",
