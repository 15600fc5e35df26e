"""The benchmark: all learners on the same scenarios, compared by robot moves, which cost time."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from replication.config.study import Study
from replication.scenarios.resolving import resolve
from replication.training.competitors import MOVES, make_peer
from replication.training.poses import Stream, train_for_results
from replication.training.tuned import Tuned


def compete(study: Study, learner: str, settings: Sequence[Path]) -> pd.DataFrame:
    """Train a learner on each scenario of the benchmark, each time from the beginning.

    Returns a row for each scenario, seed and number of moves.
    """
    plan, runs, frames = study.benchmark, range(study.benchmark.seeds), []
    papers = learner in plan.papers
    moves_each = MOVES if papers else 1
    iterations = plan.papers[learner] if papers else max(plan.moves)
    budgets = [
        moves // moves_each
        for moves in (*plan.moves, *plan.longer)
        if moves % moves_each == 0 and moves <= iterations * moves_each
    ]
    for scenario in resolve(study, study.robot, plan.scenarios)[0]:
        controller = scenario.controller()
        competitor = (
            Tuned(study, settings).learner(learner, iterations, plan.seeds)
            if papers
            else make_peer(learner, plan.seeds, controller.robot)
        )
        poses = Stream.SCENARIO.draw(
            study.seed, runs, iterations, study.training.tests, scenario=scenario.scenario
        )
        plant = scenario.plant(controller, study.seed, runs)
        history = train_for_results(plant, competitor, poses, budgets)
        frame = pd.DataFrame(history.columns()).rename(columns={"run": "seed"})
        frames.append(frame.assign(scenario=scenario.scenario, learner=learner))
    return pd.concat(frames, ignore_index=True)
