"""A universe: a small study of its own, with one reading of all that the paper leaves open."""

import math
from collections.abc import Mapping
from typing import Any

from recalib.study.configuration.damages import Entry
from recalib.study.configuration.part import Frozen
from recalib.study.configuration.study import (
    Budget,
    LearnerSettings,
    Ranges,
    Study,
    WorkspaceSettings,
)
from recalib.study.configuration.switches import IMPROVED, RITTER
from recalib.study.inference.measured import MOVED
from recalib.study.multiverse.design import Designed
from recalib.study.plan.trainings import budget, switched
from recalib.study.scenarios.nominal import Nominal, nominal

DIGITS = 4  # of a length in m
SMALL = (2, 2, 2)  # cells of a net that is spared some


class Conventions(Frozen):
    """Of learning, as fields of `recalib.learners.rules.Rules`."""

    centres: str
    metric: tuple[float, ...]
    dimensions: int
    spread: str
    width_units: tuple[float, ...]
    initial: int | None


class Universe(Frozen):
    """All that a run of it needs.

    Attributes:
        nominal: the robot, with home, workspace and pose coordinates.
        scenarios: damages by name, nothing in them to be assigned any more.
        learners: the two systems, each with one switch changed, and with a small net, by name.
        rate_of_visits: how the rate of learners with equal visits falls; linearly in section 7.
        ritters_rate: how the rate of learners with exponential widths falls.
        budget: of a search, and what it minimises; its seed is the universe's.
        error: of a pose, in searches and trainings.
        order: of the poses to learn from.
        rough_trials: trials of a rough search.
        rungs: numbers of iterations at which it is.
        tests: random poses for a measurement.
        seeds: of a training.
        replicates: how often all of it is measured, each time with other luck.
        seed: of trainings.
        own: name of the scenario with the paper's damage.
    """

    number: int
    nominal: Nominal
    scenarios: Mapping[str, tuple[Entry, ...]]
    learners: Mapping[str, LearnerSettings]
    conventions: Conventions
    rate_of_visits: str
    ritters_rate: str
    budget: Budget
    rough_trials: int
    error: str
    order: str
    rungs: tuple[int, ...]
    tests: int
    seeds: int
    replicates: int
    seed: int
    own: str


def universe(study: Study, designed: Designed) -> Universe:
    """The universe that the design describes."""
    levels, own = designed.levels, study.robots[study.robot]
    its = robot_in(nominal(study, levels["robot"]), levels, own.workspace, study.universes.longer)
    workspace = its.robot.workspace
    home = dict(zip(its.robot.home, map(math.radians, designed.home_deg), strict=True))
    robot = its.robot.model_copy(update={"home": home})
    translation, rotation = designed.moved
    scale = workspace.scale_to(own.workspace)
    full = _budget(budget(study), levels, designed.seed, scale)
    rough = full.model_copy(update={"rounds": 1, "trials": study.universes.rough_trials})
    return Universe(
        number=designed.universe,
        nominal=its.model_copy(update={"robot": robot}),
        scenarios={
            "intact": (),
            "translation": (translation,),
            "rotation": (rotation,),
            MOVED: (translation, rotation),
            study.scenario: designed.damage,
        },
        learners={
            name: _with_cells(study.every_learner[name], levels["cells"], own.workspace)
            for name in (IMPROVED, RITTER, *switched(study))
        }
        | {
            f"improved_small_{net}": study.learners[IMPROVED].model_copy(update={net: SMALL})
            for net in ("supernet", "subnet")
        },
        conventions=Conventions(
            centres=levels["centres"],
            metric=metric(levels["norm"], workspace),
            dimensions=int(levels["dimensions"]),
            spread=levels["spread"],
            width_units=width_units(levels["widths"], own.workspace),
            initial=designed.seed if levels["initial"] == "random" else None,
        ),
        rate_of_visits="linear",
        ritters_rate=levels["rate"],
        budget=full if levels["effort"] == "full" else rough,
        rough_trials=study.universes.rough_trials,
        error=levels["error"],
        order=levels["order"],
        rungs=study.universes.rungs,
        tests=study.training.tests,
        seeds=study.universes.seeds,
        replicates=study.universes.replicates,
        seed=designed.seed,
        own=study.scenario,
    )


def robot_in(
    nominal: Nominal, levels: Mapping[str, Any], own: WorkspaceSettings, longer: float
) -> Nominal:
    """The robot with the pose coordinates and the tool of its levels.

    Args:
        own: the workspace of the study's own robot, on which a longer tool is `longer` [m].
    """
    entry = nominal.robot
    workspace = entry.workspace.model_copy(update={"coordinates": levels["coordinates"]})
    more = round(workspace.scale_to(own) * longer, DIGITS) if levels["tool"] == "longer" else 0.0
    update = {"workspace": workspace, "beyond": entry.beyond + more}
    return nominal.model_copy(update={"robot": entry.model_copy(update=update)})


def width_units(widths: str, own: WorkspaceSettings) -> tuple[float, ...]:
    """Six factors that turn workspace coordinates into the units of widths.

    One width is as many cm as degrees on the study's own robot, whose workspace is given: on
    smaller ones, as all lengths, the centimetres shrink. The unit is the mean half-range of
    position, so that ranges of widths mean what they do in half-ranges of the workspace.
    """
    if widths == "half_ranges":
        return (1.0,) * 6
    factors = metric("centimetres_degrees", own)
    return tuple(factor / (sum(factors[:3]) / 3) for factor in factors)


def metric(norm: str, workspace: WorkspaceSettings) -> tuple[float, ...]:
    """Six factors that turn workspace coordinates into the units of the norm in (3) and (8)."""
    lengths = [side / 2 for side in workspace.position]
    angles = [side / 2 for side in workspace.orientation]
    match norm:
        case "metres_radians":
            return (*lengths, *angles)
        case "centimetres_degrees":
            return (*(100 * length for length in lengths), *map(math.degrees, angles))
    return (1.0,) * 6


def _with_cells(
    learner: LearnerSettings, cells: str, workspace: WorkspaceSettings
) -> LearnerSettings:
    """A learner with its nets; as a whole, a single map has the cells of two, doubled along the
    longest side of the workspace.
    """
    if cells == "each" or learner.maps == "separate":
        return learner
    longest = workspace.position.index(max(workspace.position))
    doubled = [(1 + (axis == longest)) * count for axis, count in enumerate(learner.supernet)]
    return learner.model_copy(update={"supernet": tuple(doubled)})


def _budget(own: Budget, levels: Mapping[str, str], seed: int, scale: float) -> Budget:
    """What a search may spend, and what it minimises; all lengths are `scale` times the study's."""
    length = scale * own.initial.position_error_cm
    initial = own.initial.model_copy(update={"position_error_cm": length})
    update = {"seed": seed, "score": levels["score"], "initial": initial}
    if levels["ranges"] == "wider":
        update["ranges"] = wider(own.ranges)
    return own.model_copy(update=update)


def wider(ranges: Ranges) -> Ranges:
    """Twice as wide in logarithms about their middles; rates and fractions stay at most 1."""
    found = {}
    for name, (low, high) in ranges:
        part = math.sqrt(high / low)  # by which a range grows at either end
        most = math.inf if name == "initial_width" else 1.0
        found[name] = float(f"{low / part:.4g}"), min(float(f"{high * part:.4g}"), most)
    return ranges.model_copy(update=found)
