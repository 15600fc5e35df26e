from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import qmc

from recalib.damaged.disturbances import Noise, Outliers, Repeatability
from recalib.errors import UnknownName
from recalib.numerics.randomness import generator
from recalib.study.configuration.study import Measuring
from recalib.study.experiments import campaign
from recalib.study.experiments.poses import Stream
from recalib.study.plan.trainings import scenario_of
from recalib.study.scenarios.plants import resolve
from workflow.scripts.call import write


def test_a_scenario_may_name_its_robot(study):
    assert scenario_of(study, "links") == ("links", "ur10")
    assert scenario_of(study, "links_encoders-z1") == ("links_encoders", "z1")
    with pytest.raises(UnknownName, match="did you mean links"):
        scenario_of(study, "link")
    with pytest.raises(UnknownName, match="expected: jaco, puma560, ur10, ur3, ur5 or z1$"):
        scenario_of(study, "links-ur7")


SPARSE = Measuring(tests=2, measure_every=4, measure_evenly=200, measurements=50)


@pytest.mark.parametrize(("iterations", "every"), [(200, 4), (10, 4), (3, 5)])
def test_short_trainings_are_measured_evenly_and_at_their_end(iterations, every):
    grid = SPARSE.model_copy(update={"measure_every": every}).during(iterations)
    assert grid[0] == 0 and grid[-1] == iterations and set(np.diff(grid[:-1])) <= {every}


def test_long_trainings_are_measured_on_a_logarithmic_grid():
    grid = SPARSE.during(10_000)
    assert grid[:3] == [0, 1, 2] and grid[-1] == 10_000 and 35 <= len(grid) <= 51


def drawn(runs, iterations, scenario="links", **how):
    return Stream.SCENARIO.draw(1, runs, iterations, 20, scenario=scenario, **how)


def test_compared_learners_see_the_same_poses_and_never_the_tests():
    short, long = drawn(range(3), 20), drawn(range(1, 3), 200)
    assert np.array_equal(short.desired[1:], long.desired[:, :20])
    assert np.array_equal(short.tests[1:], long.tests)
    assert not np.isclose(short.tests, short.desired).any()
    others = drawn(range(3), 20, scenario="encoders")
    assert not np.isclose(short.desired, others.desired).any()
    assert not np.isclose(short.desired[0], short.desired[1]).any()


def test_poses_are_independent_by_default_or_spread_evenly():
    same = generator(1, "links", 2, "desired").uniform(-1, 1, (20, 6))
    assert np.array_equal(drawn([2], 20).desired[0], same)
    short, long = (drawn([2, 3], n, order="even").desired for n in (20, 200))
    assert np.array_equal(short, long[:, :20])
    assert (
        not np.isclose(long[0], long[1]).any() and -1 < long.min() < -0.98 < 0.98 < long.max() < 1
    )
    random = drawn([2, 3], 200).desired
    for one, other in zip(long, random, strict=True):
        assert qmc.discrepancy((one + 1) / 2) < 0.2 * qmc.discrepancy((other + 1) / 2)


def test_moves_that_the_controller_refused_by_the_end_are_told(
    study, plan, tmp_path, monkeypatch, capsys
):
    columns = {"run": np.arange(2), "iteration": np.full(2, 4)}
    history = SimpleNamespace(refused=np.array([[0, 0, 2], [0, 1, 1]]), columns=columns.copy)
    monkeypatch.setattr(campaign, "train_for_results", lambda *_: history)
    for name in ("build_tuned", "save"):
        monkeypatch.setattr(campaign, name, lambda *_: None)
    write(scenario := tmp_path / "links.json", plan.resolved("links"))
    rules = study.every_learner["improved"]
    measuring = Measuring(tests=2, measure_every=4, measure_evenly=4, measurements=2)
    files = scenario, tmp_path / "improved.csv", tmp_path / "improved.npz"
    found = campaign.train_seeds(*files, rules, 2, 0, 2, measuring, False, 1)
    assert "improved on links: the controller refused 3 moves" in capsys.readouterr().err
    assert found["seed"].tolist() == [0, 1] and found["search"].tolist() == [1, 1]


def test_every_run_of_every_scenario_has_luck_of_its_own_that_repeats(plan):
    """So a run that is trained in another chunk meets the same noise."""
    noisy = Noise(1e-3, 1e-3), Outliers(0.3, 0.05), Repeatability(1e-3)
    commands = np.zeros((1, 4, 6))

    def met(name, seed, runs):
        resolved = resolve(name, plan.nominal("ur10"), noisy, poses=2, seed=1)
        plant = resolved.plant(resolved.controller(), seed, runs)
        return plant.execute(np.repeat(commands, len(runs), axis=0)).achieved

    both = met("noise", 1, [3, 4])
    assert np.array_equal(both[1:], met("noise", 1, [4]))
    for other in (both[:1], met("outliers", 1, [4]), met("noise", 2, [4])):
        assert not np.isclose(both[1:], other).any()
