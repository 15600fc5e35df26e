"""What small studies of the mapping find is as kept."""

from functools import partial

import numpy as np

from recalib.damaged.damage import BaseShift, EncoderShift, LinkShortening
from recalib.study.mapping import measured, propagation, quantisation, visits
from recalib.study.mapping.true_mapping import mapping_jacobians, true_commands
from recalib.study.scenarios.plants import Resolved
from tests.kept import plain


def test_coupling_propagation_and_quantisation(uneven_scenario, monkeypatch, data_regression):
    monkeypatch.setattr(quantisation, "PLACING", 200)
    few = partial(quantisation.quantisation, shape=(2, 3, 2), iterations=(30, 80), seeds=3)
    monkeypatch.setattr(measured, "quantisation", few)
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
    names = "coupling", "propagation", "quantisation"
    data_regression.check(plain(dict(zip(names, tables, strict=True))))


def test_visits_by_width_and_distance(data_regression):
    data_regression.check(plain(visits.visits(4, samples=20_000)))


def test_the_true_mapping_and_its_jacobians(uneven_scenario, data_regression):
    resolved = Resolved.read(uneven_scenario)
    controller = resolved.controller()
    arm, rng = resolved.arm(controller.robot), np.random.default_rng(6)
    desired = controller.robot.workspace.sample(rng, 5)
    found = true_commands(controller, arm, desired), mapping_jacobians(controller, arm, desired)
    data_regression.check(plain([its.round(6) for its in found]))


def test_damages_that_grow(data_regression):
    damages = [
        LinkShortening("forearm_link", 0.04),
        EncoderShift("wrist_1_joint", -0.06),
        BaseShift((0.01, 0.02, 0.03), (0.1, 0.2, 0.3)),
    ]
    found = [propagation.grown(damages, scale) for scale in (0.3, 2.0)]
    data_regression.check(plain(found))
