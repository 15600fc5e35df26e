"""Resolve a study's scenarios: assign the paper's damage, and compute initial errors."""

from collections.abc import Iterable, Sequence

import numpy as np

from recalib.damaged.damage import apply
from recalib.damaged.plant import Plant
from recalib.nominal.workspace import orientation_error, position_error
from recalib.numerics.randomness import generator
from replication.config.damages import Assigned, Entry, damages_among
from replication.config.study import Study
from replication.scenarios.assignments import Assignment, assign
from replication.scenarios.plants import Nominal, Resolved, nominal_controller, nominal_of


def has_part(study: Study, scenarios: Iterable[str]) -> bool:
    """Whether any of these scenarios has a part of the paper's damage."""
    return any(isinstance(entry, Assigned) for name in scenarios for entry in study.scenarios[name])


def resolve(
    study: Study, robot: str, scenarios: Sequence[str]
) -> tuple[list[Resolved], dict[str, np.ndarray]]:
    """Resolved scenarios of a robot, and the table of `assign`, empty if no scenario needs it."""
    nominal = nominal_of(study, robot)
    table: dict[str, np.ndarray] = {}
    assignment: Assignment = ()
    if has_part(study, scenarios):
        table, assignment = assign(nominal, study.paper_damage, study.seed)
    return [_resolved(study, nominal, name, assignment) for name in scenarios], table


def _resolved(study: Study, nominal: Nominal, scenario: str, assignment: Assignment) -> Resolved:
    """A scenario with its part of an assignment, and its mean initial errors over random poses."""
    damages: list[Entry] = []
    for entry in study.scenarios[scenario]:
        damages += entry.part_of(assignment) if isinstance(entry, Assigned) else [entry]
    controller = nominal_controller(nominal)
    workspace = controller.robot.workspace
    random = generator(study.seed, scenario, "initial errors")
    tests = workspace.sample(random, 1, study.paper_damage.poses)
    arm = apply(controller.robot, damages_among(damages))
    achieved, _ = Plant(controller, arm).achieve(tests)
    desired = workspace.to_poses(tests)
    return Resolved(
        scenario=scenario,
        robot=nominal.name,
        damages=tuple(damages),
        workspace={
            "centre": workspace.centre.round(6).tolist(),
            "half_ranges_m_rad": workspace.half_ranges.round(6).tolist(),
        },
        initial_position_error_cm=100 * position_error(achieved, desired).mean(),
        initial_orientation_error_deg=np.degrees(orientation_error(achieved, desired).mean()),
        nominal=nominal,
    )
