"""The job that resolves the scenarios of all places in the plan."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from recalib.files.storage import whole
from replication.config.study import Study
from replication.scenarios.resolving import resolve
from replication.training.plan import places


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
