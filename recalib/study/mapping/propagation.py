"""Is the new mapping nearer to the old one than to a constant (section 5)? E_clas and E_upd."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from recalib.damaged.damage import Damage, EncoderShift, LinkShortening, apply
from recalib.randomness import generator
from recalib.study import jobs
from recalib.study.configuration.damages import damages_among
from recalib.study.mapping.true_mapping import mapping_jacobians, true_commands
from recalib.study.plants import Resolved

if TYPE_CHECKING:
    import pandas as pd

Mapping = Callable[[np.ndarray], np.ndarray]


def ball(generator: np.random.Generator, points: int, dimensions: int, radius: float) -> np.ndarray:
    """Points (points, dimensions) drawn uniformly from a ball about zero."""
    directions = generator.normal(size=(points, dimensions))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return radius * directions * generator.uniform(size=(points, 1)) ** (1 / dimensions)


def propagation_errors(
    old: Mapping, new: Mapping, centre: np.ndarray, offsets: np.ndarray
) -> tuple[float, float]:
    """E_clas and E_upd of section 5, as means over the ball instead of integrals.

    Args:
        old, new: f and f', from points (n, 6) to values (n, ...): commands, or Jacobians for the
            second half of the section.
        centre: (6,) of the ball, where the winner is.
        offsets: (n, 6) points of the ball relative to its centre.
    """
    points = centre + offsets
    f, f_new = old(points), new(points)
    f_centre, f_new_centre = old(centre[None]), new(centre[None])
    axes = tuple(range(1, f.ndim))
    classic = np.square(f_new_centre - f_new).sum(axis=axes)
    updated = np.square(f + (f_new_centre - f_centre) - f_new).sum(axis=axes)
    return float(classic.mean()), float(updated.mean())


def grown(damages: Sequence[Damage], scale: float) -> list[Damage]:
    """The paper's damage made smaller or larger: links are shortened by what it says at most."""
    links = [each.scaled(min(scale, 1)) for each in damages if isinstance(each, LinkShortening)]
    encoders = [each.scaled(scale) for each in damages if isinstance(each, EncoderShift)]
    return [*links, *encoders]


def propagation(job: jobs.TrueMapping, scenario: str | Path) -> "pd.DataFrame":
    """Both integrals in balls about random centres, from slight to large damage.

    Args:
        job: how many balls, how large, and the scales of the damage.
        scenario: file of the paper's damage as resolved.

    Returns a row for each scale, start (intact: the damage; damaged: as much again on top of it),
    kind (theta, jacobian) and ball, with columns classic (E_clas) and updated (E_upd).
    """
    import pandas as pd  # a quarter of a second: no start waits for it

    resolved, plan = Resolved.read(scenario), job.plan
    controller = resolved.controller()
    robot, damages = controller.robot, damages_among(resolved.damages)
    random = partial(generator, job.seed, "study")
    offsets = ball(random("ball"), plan.points, 6, plan.radius)
    centres = robot.workspace.sample(random("centres"), plan.balls) * (1 - plan.radius)
    starts = {"intact": [], "damaged": damages}
    rows = []
    for scale in plan.scales:
        for start, before in starts.items():
            arms = [apply(robot, each) for each in (before, [*before, *grown(damages, scale)])]
            for kind, mapping in (("theta", true_commands), ("jacobian", mapping_jacobians)):
                old, new = (partial(mapping, controller, arm) for arm in arms)
                errors = [propagation_errors(old, new, centre, offsets) for centre in centres]
                rows += [
                    {"scale": scale, "start": start, "kind": kind, "classic": c, "updated": u}
                    for c, u in errors
                ]
    return pd.DataFrame(rows)
