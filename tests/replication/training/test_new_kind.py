"""A new kind of learner is named in one place; all the rest knows it from there."""

import numpy as np
import pytest

from recalib.learners.geometric import GeometricLearner
from recalib.learners.kinds import KINDS, KINEMATICS, POSES, Kind
from recalib.learners.learned import load, save
from recalib.learners.polynomial import PolynomialLearner
from replication.plots.palette import STYLES, styles_of
from replication.running.checks.consistency import check
from replication.training.benchmark import compete
from replication.training.competitors import label_of, make_peer, needs_of, peers
from replication.training.real_arm import remaining_errors
from replication.training.tracker import TrackerMeasurements


class Pure(PolynomialLearner):
    """It needs no kinematics, and has settings."""


class Handbook(GeometricLearner):
    """It knows the kinematics, and has no settings."""


NEW = {
    Pure: Kind(f"{__name__}.Pure", {"by Taylor": {"degree": 1}}, POSES),
    Handbook: Kind(f"{__name__}.Handbook", {"by Taylor": {}}, KINEMATICS),
}


@pytest.fixture(params=NEW)
def new(request, monkeypatch) -> type:
    monkeypatch.setitem(KINDS, "new", NEW[request.param])
    return request.param


def test_a_new_kind_is_known_by_its_name_need_and_look(new):
    assert [*peers()][-1] == "by_taylor"
    assert label_of("by_taylor") == "by Taylor" and needs_of("by_taylor") == NEW[new].needs
    shown = styles_of([*STYLES, "by_taylor"])
    assert shown["by_taylor"].label == "by Taylor"
    assert shown["by_taylor"].color not in {style.color for style in STYLES.values()}


def test_a_study_may_name_a_new_kind(new, study):
    def naming(part, name):
        its = getattr(study, part)
        learners = {"learners": (*its.learners, name)}
        return check(study.model_copy(update={part: its.model_copy(update=learners)}))

    for part in ("benchmark", "real"):
        assert naming(part, "by_taylor") == [] != naming(part, "by_nobody")


def test_a_new_kind_competes_and_its_file_is_read(new, study, robot, tmp_path):
    training = study.training.model_copy(update={"tests": 5})
    plan = {"scenarios": ("translation",), "seeds": 2, "moves": (1, 8), "longer": ()}
    benchmark = study.benchmark.model_copy(update=plan)
    its = study.model_copy(update={"benchmark": benchmark, "training": training})
    errors = compete(its, "by_taylor", []).groupby("moves")["position_error_cm"].mean()
    assert errors[8] < errors[1] / 2
    save(tmp_path / "learned.npz", make_peer("by_taylor", 1, robot), robot)
    assert type(load(tmp_path / "learned.npz", robot)) is new


def test_a_new_kind_learns_from_recorded_poses(new, robot, damaged):
    angles = robot.home + 0.1 * np.random.default_rng(1).standard_normal((60, 6))
    there, nominal = (its.forward(angles)[:, :3, 3] for its in (damaged, robot.arm))
    recorded = TrackerMeasurements(angles, nominal, there)
    before, after = (
        remaining_errors(name, robot, recorded[:40], recorded[40:]).mean()
        for name in ("uncorrected", "by_taylor")
    )
    assert after < before / 3
