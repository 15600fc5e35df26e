"""What both jobs measure is what claims and figures read."""

import numpy as np
import pytest

from replication.config import root_of
from replication.judgement import Evidence, Verdict
from replication.judgement.claims import Measured, claims
from replication.mapping import jobs, nearness, quantisation, solutions
from replication.running import write
from replication.training import Place, constant_widths, places, write_scenarios
from tests.conftest import changed

FIRST = "coupling", "nearness", "propagation", "quantisation", "solutions", "visits"
SECOND = "replay", "widths"
JUDGED = {  # by tables of the mapping alone
    "single-valued": Verdict.SUPPORTED,
    "theta-reason": Verdict.SUPPORTED,
    "jacobian-reason": Verdict.SUPPORTED,
    "expected-learning": Verdict.SUPPORTED,
    "controller-kept": Verdict.SUPPORTED,
}
OF_MORE = "grid", "weak-coupling-reason", "coarse-widths"  # draws and seeds than there are here


@pytest.fixture(scope="module")
def few(study):
    plan = {"scenarios": ("links_encoders", "rotation"), "robots": ()}
    mapping = {"poses": 6, "balls": 3, "points": 10, "scales": (0.5, 1.0)}
    return changed(study, experiments=plan, mapping=mapping, name="few")


@pytest.fixture(scope="module")
def evidence(few, settings, tmp_path_factory):
    folder = tmp_path_factory.mktemp("mapping")
    root = folder / root_of(few.name)
    files = {place: folder / place.scenario_file(root_of(few.name)) for place in places(few)}
    own = files[Place(few.robot, few.scenario)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(quantisation, "PLACING", 500)
        patch.setattr(quantisation, "EVALUATING", 500)
        patch.setattr(nearness, "DRAWS", 2)
        patch.setattr(solutions, "STARTS", 10)
        patch.setattr(constant_widths, "SEEDS", 2)
        patch.setattr(constant_widths, "RATES", np.array([0.8]))
        write_scenarios(few, [*files.values()])
        tables = dict(zip(FIRST, jobs.measure(few, [*files.values()], own), strict=True))
        tables |= dict(zip(SECOND, jobs.learn(few, own, settings), strict=True))
    for name, table in tables.items():
        write(root / f"mapping/{name}.parquet", table)
    return Evidence(few, folder)


@pytest.mark.parametrize("name", [*JUDGED, *OF_MORE])
def test_claims_about_the_mapping_are_judged_by_what_is_measured(few, evidence, name):
    claim = next(claim for claim in claims(few) if claim.id == name)
    assert isinstance(claim, Measured)
    finding = claim.judge(evidence)
    assert all(np.isfinite(estimate.value) for estimate in finding.estimates) and finding.estimates
    if name in JUDGED:
        assert finding.verdict is JUDGED[name]
    assert name != "expected-learning" or "learns 50 % of what the formula" in finding.note
