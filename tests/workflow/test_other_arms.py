"""Arms of example-robot-data that config.yaml does not know, from their URDF to what came out."""

import pandas as pd
import pytest
import yaml

from tests.project import Project
from tests.replication.config.test_own_robots import ARMS, entry_of
from tests.workflow.conftest import CORES

LESS = {
    "experiments": {"scenarios": ["links_encoders"], "switches": False},
    "training": {"seeds": 2, "tests": 20},
    "search": {"searches": 2},
}


@pytest.mark.slow
@pytest.mark.parametrize("urdf", ["kinova.urdf", "xarm7.urdf"])
def test_another_arm_is_damaged_trained_drawn_and_recorded(urdf, tmp_path):
    """One of six joints and one of seven, with the paper's damage."""
    row = next(row for row in ARMS if row["urdf"] == urdf)
    mine = {"like": "quick", "robot": "mine", "robots": {"mine": entry_of(row)}} | LESS
    project = Project(tmp_path, *CORES, "--configfile", "mine.yaml", name="mine")
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(mine), encoding="utf-8")
    project.run().well()
    results = project.results
    table = pd.read_csv(results / "summary.csv").set_index("learner")
    assert {*table.index} == {"improved", "ritter"} and {*table["robot"]} == {"mine"}
    improved = table.loc["improved"]
    for error in ("position_error_cm", "orientation_error_deg"):
        assert improved[f"final_{error}"] < 0.2 * improved[f"initial_{error}"]
    assert (results / "recordings" / "links_encoders.rrd").stat().st_size > 1e5
    for made in ("claims.json", "figures/figure1.svg"):
        assert (results / made).exists()
