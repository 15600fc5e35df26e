"""Trainings on many robots, in chunks or all at once."""

from functools import partial

import pytest

from replication.scenarios.assignments import Ways
from replication.training.ensemble import feasible, train_draws
from replication.training.joining import put_together
from replication.training.trainings import rules
from tests.conftest import ROOT

SCALES = 1.0, 3.0


@pytest.fixture(scope="module")
def train(study, plan):
    damage = study.paper_damage
    return partial(
        train_draws,
        sample=ROOT / "workflow" / "search" / "improved_200.csv",
        nominal=plan.nominal("ur10"),
        shorten=damage.shorten,
        shift=damage.shift,
        series="scaled",
        scales=SCALES,
        rules=rules(study, "improved").model_copy(update={"iterations": 5}),
        tests=10,
        seed=1,
    )


def test_each_robot_has_links_long_enough_for_the_largest_damage(train, study, plan, robot):
    """Though the smallest leaves more of them to draw from."""
    damage = study.paper_damage
    ways = Ways(plan.nominal("ur10").robot.links, damage.shorten, robot.joints, damage.shift)
    some = range(0, len(ways), 40)
    assert len([*feasible(robot, ways, some, min(SCALES))]) == len(some)
    assert len([*feasible(robot, ways, some, max(SCALES))]) < len(some)
    table = train(first=0, last=6)
    assert table[["robot", "scale"]].to_numpy().tolist() == [
        [n, by] for n in range(6) for by in SCALES
    ]
    error = table["initial_position_error_cm"].to_numpy().reshape(-1, 2)
    assert (error[:, 1] > 2 * error[:, 0]).all()


def test_in_chunks_it_is_as_all_at_once(train, tmp_path):
    files = [tmp_path / f"{first}.parquet" for first in (0, 2)]
    for file, last in zip(files, (2, 3), strict=True):
        train(first=int(file.stem), last=last).to_parquet(file)
    assert put_together(files).to_pandas().equals(train(first=0, last=3))
