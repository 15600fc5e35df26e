"""A setup: one way to decide all that the paper leaves open. Setup 0 is the reference study.

The design lists all setups, with a feasible home for each robot. It is drawn before anything is
measured, and stored in a readable table.
"""

import csv
import math
from collections.abc import Mapping
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any, Self

import pandas as pd
import yaml

from recalib.learners.rules import Rules
from replication.config.damages import Entry, describe
from replication.config.part import Frozen
from replication.config.shipped import OUTCOMES
from replication.config.study import Study, WorkspaceSettings
from replication.scenarios.plants import Nominal, nominal_of

DIGITS = 4  # decimals of a length in m
LINE = 1000  # characters, more than any list of damages has


class Setup(Frozen):
    """A row of the design."""

    setup: int  # its number
    row: int  # its number in the design's sequence; skipped numbers are infeasible rows
    seed: int  # for searches, poses and trainings
    levels: dict[str, str]  # the level of each factor
    # joint angles at the centre of the workspace, in the order of the configuration
    home_deg: tuple[float, ...]
    homes_refused: int  # number of random homes that the controller refused before this one
    damage: tuple[Entry, ...]  # the paper's damage, as assigned to the robot
    # mean errors of the arm without correction
    position_error_cm: float
    orientation_error_deg: float

    def nominal(self, study: Study) -> Nominal:
        """The robot with its home, tool, workspace and pose coordinates."""
        nominal = robot_in(nominal_of(study, self.levels["robot"]), self.levels, study)
        home = dict(zip(nominal.robot.home, map(math.radians, self.home_deg), strict=True))
        return nominal.model_copy(update={"robot": nominal.robot.model_copy(update={"home": home})})

    def rules(self, rules: Rules, study: Study, improved: bool) -> Rules:
        """Rules of a learner with the conventions of the setup.

        Args:
            improved: whether the learner is a variant of the improved system, whose rate falls
                linearly (section 7), or of Ritter's.
        """
        levels, workspace = self.levels, self.nominal(study).robot.workspace
        return replace(
            rules,
            centres=levels["centres"],
            metric=metric(levels["norm"], workspace),
            dimensions=int(levels["dimensions"]),
            spread=levels["spread"],
            width_units=width_units(levels["widths"], study.robots[study.robot].workspace),
            rate="linear" if improved else levels["rate"],
        )

    def as_row(self) -> dict[str, Any]:
        """The setup as a row of the table."""
        row = {name: getattr(self, name) for name in type(self).model_fields}
        row["home_deg"] = " ".join(f"{angle:g}" for angle in self.home_deg)
        entries = [describe(entry) for entry in self.damage]
        text = yaml.safe_dump(entries, default_flow_style=True, sort_keys=False, width=LINE)
        row["damage"] = text.strip()
        levels = row.pop("levels")
        return {"setup": row.pop("setup"), "row": row.pop("row")} | levels | row

    @classmethod
    def from_row(cls, row: Mapping[str, str]) -> Self:
        """The setup of a row of the table."""
        levels = {name: text for name, text in row.items() if name not in cls.model_fields}
        rest: dict[str, Any] = {name: text for name, text in row.items() if name not in levels}
        rest["home_deg"] = rest["home_deg"].split()
        rest["damage"] = yaml.safe_load(rest["damage"])
        return cls.model_validate(rest | {"levels": levels})


def planned(study: Study) -> list[tuple[int, int]]:
    """Each setup and replicate whose outcomes are not in the table yet, in measuring order.

    Setups with several replicates come first, so that the table is useful early.
    """
    plan = study.campaign
    measurements = [*product(range(plan.replicated), range(plan.replicates))]
    measurements += [(setup, 0) for setup in range(plan.replicated, plan.setups)]
    shipped = Path(OUTCOMES)
    outcomes = pd.read_csv(shipped)[["setup", "replicate"]] if shipped.exists() else pd.DataFrame()
    measured = set(outcomes.itertuples(index=False, name=None))
    return [measurement for measurement in measurements if measurement not in measured]


def read_design(path: str | Path) -> list[Setup]:
    """The setups of a table."""
    with Path(path).open(encoding="utf-8", newline="") as file:
        return [Setup.from_row(row) for row in csv.DictReader(file)]


def robot_in(nominal: Nominal, levels: Mapping[str, Any], study: Study) -> Nominal:
    """A robot with the pose coordinates and the tool of a setup's levels.

    The extra length of a longer tool is in proportion to the workspace.
    """
    entry, own = nominal.robot, study.robots[study.robot].workspace
    workspace = entry.workspace.model_copy(update={"coordinates": levels["coordinates"]})
    longer = levels["tool"] == "longer"
    more = round(workspace.scale_to(own) * study.campaign.longer, DIGITS) if longer else 0.0
    update = {"workspace": workspace, "beyond": entry.beyond + more}
    return nominal.model_copy(update={"robot": entry.model_copy(update=update)})


def width_units(widths: str, own: WorkspaceSettings) -> tuple[float, ...]:
    """Six factors that convert workspace coordinates into the units of widths.

    `own` is the workspace of the study's own robot, on which a width spans as many centimetres as
    degrees; on other robots lengths are in proportion to their workspaces. The unit is the mean
    half-range of position, so that ranges of widths remain comparable with half-ranges.
    """
    if widths == "half_ranges":
        return (1.0,) * 6
    factors = metric("centimetres_degrees", own)
    return tuple(factor / (sum(factors[:3]) / 3) for factor in factors)


def metric(norm: str, workspace: WorkspaceSettings) -> tuple[float, ...]:
    """Six factors that convert workspace coordinates into units of the norm in (3) and (8)."""
    lengths = [side / 2 for side in workspace.position]
    angles = [side / 2 for side in workspace.orientation]
    match norm:
        case "metres_radians":
            return (*lengths, *angles)
        case "centimetres_degrees":
            return (*(100 * length for length in lengths), *map(math.degrees, angles))
    return (1.0,) * 6
