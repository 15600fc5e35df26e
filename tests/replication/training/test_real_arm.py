"""What a tracker sees is made here, of an arm that the tests bend: real data are not shipped."""

import hashlib
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from recalib import (
    Description,
    EccentricGear,
    EncoderShift,
    InvalidFile,
    LinkShortening,
    RecalibError,
    Row,
    apply,
    arm_of_table,
    read_description,
)
from recalib.laboratory.plausibility.mistakes import Mistaken
from replication.config import Source
from replication.scenarios import nominal_robot
from replication.training import (
    Tuned,
    fetch,
    fetched,
    learn,
    peers,
    read_of,
    read_whole_description,
    remaining_errors,
    with_tool_point,
)
from tests.conftest import ROOT, changed

# As the manufacturer gives it: a and d [m] and twists of the Denavit-Hartenberg convention.
DH_A = 0, -0.425, -0.39225, 0, 0, 0
DH_D = 0.089159, 0, 0, 0.10915, 0.09465, 0.0823
DH_TWIST = np.pi / 2, 0, 0, np.pi / 2, -np.pi / 2, 0
MANUFACTURERS = arm_of_table([*map(Row, "123456", DH_A, DH_TWIST, DH_D)])
# With it the manufacturer's arm gets to the nominal positions of the public tables, to 0.01 mm.
TOOL_POINT = 0.0, 0.07e-3, 31e-3  # m


@pytest.fixture(scope="module")
def description(plan):
    return read_description(ROOT / plan.study.real.description)


@pytest.fixture(scope="module")
def ur5(plan, description):
    return with_tool_point(nominal_robot(plan.nominal("ur5")), description.target[:3, 3])


@pytest.fixture(scope="module")
def table(ur5) -> pd.DataFrame:
    """150 poses of an arm with small defects, with 0.02 mm of noise, as tables have them."""
    generator = np.random.default_rng(1)
    middle = np.radians([20, -65, 100, -40, 95, 0])
    angles = middle + np.radians([22, 18, 20, 28, 23, 8]) * generator.uniform(-1.5, 1.5, (150, 6))
    defects = [
        LinkShortening("forearm_link", 0.001),
        EncoderShift("shoulder_lift_joint", 0.002),
        EccentricGear("elbow_joint", 0.003, 0.4),
    ]
    measured = apply(ur5, defects).forward(angles)[:, :3, 3] * [-1, -1, 1]
    nominal = (MANUFACTURERS.forward(angles) @ [*TOOL_POINT, 1])[:, :3]
    errors = measured - nominal + 2e-5 * generator.standard_normal((150, 3))
    columns = {"step_order": range(150)}
    columns |= {f"joint_{number + 1}": np.degrees(angles[:, number]) for number in range(6)}
    columns |= {f"{axis}_t": 1e3 * nominal[:, index] for index, axis in enumerate("xyz")}
    columns |= {f"{axis}_dif": 1e3 * errors[:, index] for index, axis in enumerate("xyz")}
    return pd.DataFrame(columns)


@pytest.fixture(scope="module")
def recording(table, ur5, description, tmp_path_factory):
    path = tmp_path_factory.mktemp("recorded") / "recording.csv"
    table.to_csv(path, index=False)
    return read_of(ur5.arm, path, description)


def test_learners_leave_ever_smaller_errors_of_what_was_recorded(recording, ur5):
    reached = ur5.arm.forward(recording.angles)[:, :3, 3]
    distance = np.linalg.norm(reached - recording.nominal, axis=1)
    assert distance.max() < 5e-5
    fit, test = recording[:100], recording[100:]
    errors = {name: 1e3 * remaining_errors(name, ur5, fit, test).mean() for name in peers()}
    assert errors["uncorrected"] == pytest.approx(
        1e3 * np.linalg.norm(test.measured - test.nominal, axis=1).mean()
    )
    assert errors["affine"] < errors["uncorrected"] / 2
    assert errors["quadratic"] < errors["affine"]
    assert errors["gaussian_process"] < errors["affine"]
    assert errors["geometric"] < errors["quadratic"]
    assert errors["hybrid"] < 0.04 < 0.07 < errors["geometric"]


@pytest.mark.parametrize("learner", peers())
def test_what_is_tested_on_teaches_nothing(learner, recording, ur5):
    """Where the tests were measured 1 m farther up, all of that metre remains.

    And what remains of one test is the same whichever others there are.
    """
    up = [0, 0, 1.0]
    tests = recording[100:110]
    far = replace(tests, measured=tests.measured + up)
    errors = remaining_errors(learner, ur5, recording[:30], far)
    assert np.abs(errors - 1).max() < 0.01
    alone = remaining_errors(learner, ur5, recording[:30], far[:1])
    assert alone == pytest.approx(errors[:1], abs=1e-9)


@pytest.fixture
def files(table, tmp_path):
    """The tables, and what they do not say themselves."""
    fit, test = tmp_path / "fit.csv", tmp_path / "test.csv"
    table[:40].to_csv(fit, index=False)
    table[100:].to_csv(test, index=False)
    return fit, test, ROOT / "workflow/real/ur5.toml"


def learned(study, files, learner, poses, subsets, settings=(), **changes):
    real = {"poses": poses, "subsets": subsets} | changes
    return learn(changed(study, real=real), learner, *files, settings)


def test_of_several_poses_there_are_subsets_and_of_all_of_them_one(study, files, monkeypatch):
    found = learned(study, files, "affine", (10, 40), 3)
    assert found[["poses", "subset"]].to_numpy().tolist() == [[10, 0], [10, 1], [10, 2], [40, 0]]
    assert found["position_error_mm"].nunique() == 4 and not found["twin"].any()
    # another number of poses draws other subsets, not more of the same
    fitted = []
    monkeypatch.setattr(
        "replication.training.real_arm.remaining_errors",
        lambda _, robot, known, tests: fitted.append({*known.angles[:, 0]}) or np.ones(1),
    )
    learned(study, files, "affine", (10, 20), 2)
    assert not any(few <= more for few in fitted[:2] for more in fitted[2:])
    monkeypatch.undo()
    nothing = learned(study, files, "uncorrected", (10, 40), 3)
    assert nothing["position_error_mm"].nunique() == 1 and len(nothing) == 2


def test_on_a_twin_a_learner_chooses_its_poses(study, files, settings, monkeypatch):
    few = changed(study, training={"tests": 5})
    requested, learner = [], Tuned.learner

    def noted(self, *what):
        requested.append(what)
        return learner(self, *what)

    monkeypatch.setattr(Tuned, "learner", noted)
    twin = {"improved": 200}
    found = learned(few, files, "improved", (2, 4, 1000), 3, settings, twin=twin)
    assert requested == [("improved", 200, 3)]
    assert found["twin"].all() and found["subset"].tolist() == [0, 0, 0, 1, 1, 1, 2, 2, 2]
    assert found["poses"].tolist() == [2, 4, 400] * 3  # two moves an iteration
    by_moves = found.groupby("poses")["position_error_mm"].mean()
    assert by_moves[400] < by_moves[2]


def test_tables_of_too_little_or_in_another_frame_are_refused(
    recording, ur5, tmp_path, table, description
):
    path = tmp_path / "half.toml"
    path.write_text('[target]\nposition = ["0 mm", "0 mm", "1 mm"]\n')
    with pytest.raises(InvalidFile, match=r"half\.toml: its instrument or its target is missing"):
        read_whole_description(path)
    columns = {f"{joint} [rad]": recording.angles[:, i] for i, joint in enumerate(ur5.joints)}
    columns |= {f"{axis} [m]": recording.measured[:, i] for i, axis in enumerate("xyz")}
    pd.DataFrame(columns).to_csv(tmp_path / "half.csv", index=False)
    with pytest.raises(InvalidFile, match="x_nominal, y_nominal, z_nominal or measured posi"):
        read_of(ur5.arm, tmp_path / "half.csv", Description(instrument=np.eye(4)))
    path = tmp_path / "table.csv"
    table.assign(x_t=-table["x_t"], y_t=-table["y_t"]).to_csv(path, index=False)
    with pytest.raises(Mistaken, match=r"likely: the base turned by 180\.0 deg"):
        read_of(ur5.arm, path, description)


def test_another_table_than_the_one_that_is_meant_is_refused(study, tmp_path):
    path, digest = tmp_path / "given.csv", "0" * 64
    path.write_text("a table")
    actual = hashlib.sha256(path.read_bytes()).hexdigest()
    right, wrong = (
        Source(url="https://there", file=str(path), sha256=sha256) for sha256 in (actual, digest)
    )
    assert fetched(right) == b"a table"
    with pytest.raises(RecalibError, match=f"has SHA-256 {actual}; expected {digest}"):
        fetch(changed(study, real={"data": {"fit": right, "test": wrong}}))
    gone = str(tmp_path / "gone.csv")
    with pytest.raises(RecalibError, match=r"gone.csv is out of reach .* set `file` in real"):
        fetched(Source(url="https://there", file=gone, sha256="0" * 64))
