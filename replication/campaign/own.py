"""The search for settings in a study of one's own, with the campaign's method."""

import math
from pathlib import Path

import pandas as pd

from replication.campaign.measuring import Replicate
from replication.campaign.setups import Setup
from replication.campaign.variants import Variant
from replication.config.campaign import Factors
from replication.config.study import Study
from replication.scenarios.plants import Resolved
from replication.training.tuned import rules_of, trained


def tune(study: Study, learner: str, scenario: Path) -> pd.DataFrame:
    """Rows of settings of a learner, one for each number of training iterations in the study.

    The learner is tuned on the study's main scenario, in the file `scenario`.
    """
    rules = rules_of(study.every_learner[learner])
    lengths = tuple(sorted(iterations for name, iterations in trained(study) if name == learner))
    # the linear rate of section 7 belongs to the schedule of equal visits
    variant = Variant(rules, lengths, improved=rules.equal_visits)
    return Replicate(study, reference(study, Resolved.read(scenario)), 0).measure(
        learner, variant, {}
    )


def reference(study: Study, scenario: Resolved) -> Setup:
    """The study's own setup: the first level of each factor, and its own scenario."""
    factors = study.campaign.factors
    levels = {name: str(getattr(factors, name)[0]) for name in Factors.model_fields}
    overrides = {"robot": study.robot, "coordinates": scenario.nominal.robot.workspace.coordinates}
    return Setup(
        setup=0,
        row=0,
        seed=study.seed,
        levels=levels | overrides,
        home_deg=tuple(map(math.degrees, scenario.nominal.robot.home.values())),
        homes_refused=0,
        damage=scenario.damages,
        position_error_cm=scenario.initial_position_error_cm,
        orientation_error_deg=scenario.initial_orientation_error_deg,
    )
