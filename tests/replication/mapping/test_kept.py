"""What small studies of the mapping find is as kept."""

from functools import partial

from replication.mapping import measured, nearness, quantisation, solutions, visits
from tests.kept import plain


def test_what_one_job_measures_of_the_mapping(uneven_scenario, monkeypatch, data_regression):
    monkeypatch.setattr(quantisation, "PLACING", 200)
    few = partial(quantisation.quantisation, shape=(2, 3, 2), iterations=(30, 80), seeds=3)
    monkeypatch.setattr(measured, "quantisation", few)
    monkeypatch.setattr(nearness, "DRAWS", 2)
    monkeypatch.setattr(solutions, "STARTS", 20)
    tables = measured.measure(
        [uneven_scenario],
        uneven_scenario,
        poses=6,
        balls=4,
        points=9,
        radius=0.3,
        scales=(0.5, 2.0),
        seed=3,
    )
    names = "coupling", "nearness", "propagation", "quantisation", "solutions"
    data_regression.check(plain(dict(zip(names, tables, strict=True))))


def test_visits_by_width_and_distance(data_regression):
    data_regression.check(plain(visits.visits(4, samples=20_000)))
