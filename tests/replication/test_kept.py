"""What the jobs compute of a small study, as it was: what changes it changes published results.

Of each column of a table and each component of a recording, count, mean, spread and ends are kept.
After a change that is meant, keep them anew: `found.to_csv(KEPT, float_format="%.7g")` in the test.
"""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from replication.config import Ensemble, Study
from replication.mapping import jobs, nearness, quantisation, solutions
from replication.recording import record
from replication.scenarios import Resolved
from replication.training import compete, constant_widths, train_ensemble
from tests.conftest import changed
from tests.logged import logged
from tests.replication.conftest import ALONE, settings_of
from tests.replication.recording.conftest import DAMAGES, INTACT, ITERATIONS, LEARNERS, OWN, trained

KEPT = Path(__file__).with_name("kept.csv")
FEWER = {
    (quantisation, "PLACING"): 500,
    (quantisation, "EVALUATING"): 500,
    (nearness, "DRAWS"): 2,
    (solutions, "STARTS"): 10,
    (constant_widths, "SEEDS"): 2,
    (constant_widths, "ITERATIONS"): ITERATIONS,
}
MAPPING = "coupling", "nearness", "propagation", "quantisation", "solutions", "visits"
LEARNING = "replay", "widths"
SCENARIOS = OWN, INTACT
COMPETITORS = "improved", "quadratic", "gaussian_process", "hybrid"


def small(study: Study) -> Study:
    """A study that takes seconds, on a robot with damages of every kind."""
    plan = {"scenarios": SCENARIOS, "iterations": ITERATIONS}
    plan |= {"learners": dict.fromkeys(LEARNERS, (ITERATIONS,))}
    plan |= {"ensemble": Ensemble(draws=3, scales=(0.5, 1.0))} | ALONE
    moves = {"papers": {"improved": 8}, "moves": (8, 16), "longer": (), "seeds": 2}
    return changed(
        study,
        scenarios=study.scenarios | {OWN: DAMAGES},
        experiments=plan,
        training={"seeds": 3, "tests": 30},
        mapping={"poses": 6, "balls": 3, "points": 10, "scales": (0.5, 1.0)},
        benchmark=moves | {"scenarios": (OWN,)},
    )


def computed(study: Study, folder: Path) -> pd.DataFrame:
    """What is kept: a row for each column of the jobs' tables."""
    files, settings = trained(study, folder), settings_of(study, folder / "outcomes.csv")
    record(study, *files)
    scenarios = [Resolved.read(path).model_dump() for path in files.scenarios]
    tables = dict(zip(SCENARIOS, map(pd.read_parquet, files.histories), strict=True))
    tables["scenarios"] = pd.DataFrame(scenarios)
    mapping = jobs.measure(study, files.scenarios, files.scenarios[0])
    tables |= dict(zip(MAPPING, mapping, strict=True))
    tables |= dict(zip(LEARNING, jobs.learn(study, files.scenarios[0], settings), strict=True))
    tables |= {name: compete(study, name, settings) for name in COMPETITORS}
    tables["ensemble"] = train_ensemble(study, settings)
    columns = {
        f"{table} {name}": columns[name]
        for table, columns in tables.items()
        for name in columns.select_dtypes("number")
    }
    columns |= {
        name: pd.Series(np.concatenate([np.ravel(part) for part in parts]))
        for name, parts in logged(files.recordings[0]).items()
    }
    return pd.DataFrame(
        {
            name: column.describe()[["count", "mean", "std", "min", "max"]]
            for name, column in columns.items()
            if column.dtype.kind in "if"
        }
    ).T


@pytest.fixture
def found(study, tmp_path, monkeypatch):
    for (module, name), value in FEWER.items():
        monkeypatch.setattr(module, name, value)
    return computed(small(study), tmp_path)


def test_jobs_compute_what_they_computed(found):
    kept = pd.read_csv(KEPT, index_col=0).astype(float)
    pd.testing.assert_frame_equal(found, kept, rtol=1e-4, atol=1e-8)
