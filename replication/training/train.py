"""The jobs of the plan: resolve all scenarios; train all learners of a robot in a scenario."""

import sys
from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from recalib.files.storage import whole
from recalib.learners.learned import save
from replication.config.study import Study
from replication.scenarios.plants import Resolved
from replication.scenarios.resolving import resolve
from replication.training.plan import Place, places, throughout
from replication.training.poses import Stream, train_for_results
from replication.training.tuned import Tuned


def write_scenarios(study: Study, resolved: Sequence[Path]) -> pd.DataFrame:
    """Resolve the scenarios of all places in the plan, and write each to its file.

    Returns all assignments of the paper's damage to the study's own robot; see `resolve`.
    """
    files, assignments = dict(zip(places(study), resolved, strict=True)), pd.DataFrame()
    for robot in dict.fromkeys(place.robot for place in files):
        selected = [place for place in files if place.robot == robot]
        scenarios, table = resolve(study, robot, [place.scenario for place in selected])
        for place, scenario in zip(selected, scenarios, strict=True):
            with whole(files[place]) as path:
                path.write_text(scenario.model_dump_json(indent=2) + "\n", encoding="utf-8")
        if robot == study.robot:
            assignments = pd.DataFrame(table)
    return assignments


def train(
    study: Study,
    robot: str,
    scenario: str,
    resolved: Path,
    settings: Sequence[Path],
    histories: Sequence[Path],
    learned: Sequence[Path],
) -> None:
    """Train every learner of a robot in a scenario, for each of its numbers of iterations.

    The poses of a seed are the same for all trainings. `histories` and `learned` are output files,
    one for each learner in the order of the plan.
    """
    place, tuned = Place(robot, scenario), Tuned(study, settings)
    resolved_scenario, seeds = Resolved.read(resolved), range(study.training.seeds)
    controller = resolved_scenario.controller()
    plan = places(study)[place].items()
    for (name, lengths), history, archive in zip(plan, histories, learned, strict=True):
        tables, learners = [], {}
        for iterations in lengths:
            learner = tuned.learner(name, iterations, len(seeds))
            poses = Stream.SCENARIO.draw(
                study.seed, seeds, iterations, study.training.tests, scenario=scenario
            )
            shown = throughout(study, place, name, iterations)
            measure_at = study.training.during(iterations) if shown else [0, iterations]
            plant = resolved_scenario.plant(controller, study.seed, seeds)
            measured = train_for_results(plant, learner, poses, measure_at)
            if refused := measured.refused[:, -1].sum():
                where = f"{name}, {iterations} iterations, on {scenario}"
                print(f"{where}: the controller refused {refused} moves", file=sys.stderr)
            table = pd.DataFrame(measured.columns()).rename(columns={"run": "seed"})
            table.insert(0, "iterations", iterations)
            tables.append(table)
            learners[iterations] = learner
        with whole(history) as path:
            pd.concat(tables, ignore_index=True).to_parquet(path, index=False)
        save(archive, learners[min(lengths)], controller.robot)
