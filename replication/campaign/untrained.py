"""Measurements in every setup without a learner: coupling of the mapping, and initial errors."""

from pathlib import Path

import pandas as pd

from recalib.damaged.damage import apply
from recalib.numerics.randomness import generator
from replication.campaign.drawing import initial_errors, ways_in
from replication.campaign.measuring import short
from replication.campaign.setups import read_design
from replication.config.damages import damages_among
from replication.config.study import Study
from replication.mapping.true_mapping import coupling
from replication.scenarios.plants import nominal_controller
from replication.training.measured import ERRORS, KINDS

POSES = 0.95  # quantile of the coupling over poses


def untrained(study: Study, design: Path) -> pd.DataFrame:
    """A row for each setup.

    Columns `position` and `orientation` are the ratios of off-diagonal to diagonal blocks of the
    mapping's Jacobian for these commands (95 % quantile over poses). The others are initial errors
    with a new random assignment of the paper's damage, scaled to the study's own robot.
    """
    rows, reference = [], study.robots[study.robot].workspace
    for setup in read_design(design):
        nominal = setup.nominal(study)
        controller, scale = nominal_controller(nominal), nominal.robot.workspace.scale_to(reference)
        random = generator(setup.seed, "untrained")
        desired = controller.robot.workspace.sample(random, study.mapping.poses)
        arm = apply(controller.robot, damages_among(setup.damage))
        worst = coupling(controller, arm, desired).quantile(POSES)
        ways = ways_in(nominal, setup.levels, study)
        drawn, error = damages_among(ways[int(random.integers(len(ways)))]), setup.levels["error"]
        tests = controller.robot.workspace.sample(random, study.paper_damage.poses)
        errors = initial_errors(controller, drawn, tests, error) / (scale, 1)
        rows.append(
            {"setup": setup.setup}
            | {kind: short(worst[kind]) for kind in KINDS}
            | dict(zip(ERRORS, map(short, errors), strict=True))
        )
    return pd.DataFrame(rows)
