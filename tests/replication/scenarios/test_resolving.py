"""Scenarios as resolved: a file of each says all that its robots are made of."""

import numpy as np
import pandas as pd
import pytest

from recalib import EncoderShift, LinkShortening, Noise, Outliers, Repeatability
from replication.judgement import Evidence, NotMeasured
from replication.running import write
from replication.scenarios import Resolved, resolve
from replication.training import places, write_scenarios
from tests.conftest import changed


@pytest.fixture(scope="module")
def few(study):
    scenarios = "intact", "links", "encoders", "links_encoders"
    plan = {"scenarios": scenarios, "robots": ("z1",)}
    damage = {"shorten": (0.04,), "shift": (0.07,), "poses": 10}
    return changed(study, experiments=plan, paper_damage=damage, name="few")


@pytest.fixture(scope="module")
def written(few, tmp_path_factory):
    folder = tmp_path_factory.mktemp("scenarios")
    files = {place: folder / place.scenario_file("results/studies/few") for place in places(few)}
    write(
        folder / "results/studies/few/assignments/ur10.parquet",
        write_scenarios(few, [*files.values()]),
    )
    return folder, files


def test_each_place_has_its_damages_by_one_assignment(few, written):
    _, files = written
    links, encoders, both, other = (
        Resolved.read(path) for place, path in files.items() if place.scenario != "intact"
    )
    assert [type(its) for its in both.damages] == [LinkShortening, EncoderShift]
    assert both.damages == links.damages + encoders.damages
    assert (other.robot, other.scenario) == ("z1", "links_encoders")
    assert other.damages[0].link.startswith("link0"), "links of its own"


def test_the_paper_s_damage_is_the_assignment_nearest_to_the_published_errors(few, written):
    folder, _ = written
    evidence = Evidence(few, folder)
    table = evidence.assignments()
    assert len(table) == 4 * 12  # links, and encoders with a sign each
    nearest = table.loc[table["distance"].idxmin()]
    scenario = evidence.scenario()
    # over other poses: ten of them
    assert scenario["initial_position_error_cm"] == pytest.approx(nearest.iloc[0], rel=0.3)
    assert scenario["initial_orientation_error_deg"] == pytest.approx(nearest.iloc[1], rel=0.3)


def test_where_no_scenario_has_a_part_of_the_paper_s_damage_nothing_is_assigned(study, tmp_path):
    _, table = resolve(study, "ur10", ["intact", "rotation"])
    assert table == {}
    evidence = Evidence(study, tmp_path)
    write(tmp_path / "results/assignments/ur10.parquet", pd.DataFrame(table))
    with pytest.raises(NotMeasured, match="assigned"):
        evidence.assignments()


def test_every_run_of_every_scenario_has_luck_of_its_own_that_repeats(study, plan):
    """Another learner meets the same noise."""
    noisy = Noise(1e-3, 1e-3), Outliers(0.3, 0.05), Repeatability(1e-3)
    commands = np.zeros((1, 4, 6))

    def met(name, seed, runs):
        resolved = changed(plan.resolved("intact"), scenario=name, damages=noisy)
        plant = resolved.plant(resolved.controller(), seed, runs)
        return plant.execute(np.repeat(commands, len(runs), axis=0)).achieved

    both = met("noise", 1, [3, 4])
    assert np.array_equal(both[1:], met("noise", 1, [4]))
    for other in (both[:1], met("outliers", 1, [4]), met("noise", 2, [4])):
        assert not np.isclose(both[1:], other).any()
