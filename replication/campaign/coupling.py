"""What the true mapping is like in every setup: no learner is needed for it."""

from pathlib import Path

import pandas as pd

from recalib.damaged.damage import apply
from recalib.numerics.randomness import generator
from replication.campaign.measuring import short
from replication.campaign.setups import read_design
from replication.config.damages import damages_among
from replication.config.study import Study
from replication.judgement.measured import KINDS
from replication.mapping.coupling import coupling
from replication.scenarios.plants import nominal_controller

POSES = 0.95  # at which the coupling is at most so large


def couplings(study: Study, design: Path) -> pd.DataFrame:
    """A row for each setup: off-diagonal over diagonal blocks of the mapping's Jacobian.

    For position and for orientation commands, at 95 % of poses.
    """
    rows = []
    for setup in read_design(design):
        controller = nominal_controller(setup.nominal(study))
        rng = generator(setup.seed, "coupling")
        desired = controller.robot.workspace.sample(rng, study.mapping.poses)
        arm = apply(controller.robot, damages_among(setup.damage))
        worst = coupling(controller, arm, desired).quantile(POSES)
        rows.append({"setup": setup.setup} | {kind: short(worst[kind]) for kind in KINDS})
    return pd.DataFrame(rows)
