"""Section 5: E_clas and E_upd, and the paper's condition for E_upd to be smaller.

"This kind of cooperation works better than Ritter et al.'s when the new function is more similar to
the original one than to a constant function", and likewise for Jacobians.
"""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
import pandas as pd

from recalib.damaged.damage import Damage, EncoderShift, LinkShortening, apply
from recalib.numerics.randomness import generator
from replication.config.damages import damages_among
from replication.config.study import Mapping
from replication.mapping.true_mapping import mapping_jacobians, true_commands
from replication.scenarios.plants import Resolved

Function = Callable[[np.ndarray], np.ndarray]


def ball(generator: np.random.Generator, points: int, dimensions: int, radius: float) -> np.ndarray:
    """Points (points, dimensions) drawn uniformly from a ball about zero."""
    directions = generator.normal(size=(points, dimensions))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return radius * directions * generator.uniform(size=(points, 1)) ** (1 / dimensions)


def propagation_errors(
    old: Function, new: Function, centre: np.ndarray, offsets: np.ndarray
) -> dict[str, float]:
    """The quantities that section 5 compares, as means over a ball instead of integrals.

    With the constants of the rules, which come from the centre c,

        classic (E_clas) = mean |f' - k_1|^2,  k_1 = f'(c),
        updated (E_upd) = mean |f' - f - k_2|^2,  k_2 = f'(c) - f(c),

    and with the best constants, which are means over the ball: to_constant, the least mean
    |f' - k|^2, and to_original, the least mean |f' - f - k|^2. These show whether f' is more
    similar to f or to a constant, independently of the rules: the paper's condition. If f itself is
    constant, like the Jacobian of an intact robot's mapping, both are equal except for rounding.

    Args:
        old, new: f and f', functions of points (n, 6) with values (n, ...): commands, or Jacobians
            for the second half of the section.
        centre: (6,) the centre of the ball: the winner's.
        offsets: (n, 6) points of the ball relative to its centre.
    """
    points = centre + offsets
    f, f_new = old(points), new(points)
    f_centre, f_new_centre = old(centre[None]), new(centre[None])

    def mean_square(values: np.ndarray) -> float:
        return float(np.square(values).sum(axis=tuple(range(1, f.ndim))).mean())

    change = f_new - f
    return {
        "classic": mean_square(f_new_centre - f_new),
        "updated": mean_square(f + (f_new_centre - f_centre) - f_new),
        "to_original": mean_square(change - change.mean(axis=0)),
        "to_constant": mean_square(f_new - f_new.mean(axis=0)),
    }


def grown(damages: Sequence[Damage], scale: float) -> list[Damage]:
    """The paper's damage, smaller or larger; links are never shortened more than in the paper."""
    links = [
        damage.scaled(min(scale, 1)) for damage in damages if isinstance(damage, LinkShortening)
    ]
    encoders = [damage.scaled(scale) for damage in damages if isinstance(damage, EncoderShift)]
    return [*links, *encoders]


def propagation(resolved: Resolved, plan: Mapping, seed: int) -> pd.DataFrame:
    """The integrals in balls about random centres, for slight to large damage.

    Returns a row for each scale, start (before the new damage: "intact", or "damaged" by the
    paper's), kind (theta, jacobian) and ball, with the columns of `propagation_errors`.
    """
    controller = resolved.controller()
    robot, damages = controller.robot, damages_among(resolved.damages)
    random = partial(generator, seed, "study")
    offsets = ball(random("ball"), plan.points, 6, plan.radius)
    centres = robot.workspace.sample(random("centres"), plan.balls) * (1 - plan.radius)
    starts = {"intact": [], "damaged": damages}
    rows = []
    for scale in plan.scales:
        for start, before in starts.items():
            arms = [apply(robot, stage) for stage in (before, [*before, *grown(damages, scale)])]
            for kind, mapping in (("theta", true_commands), ("jacobian", mapping_jacobians)):
                old, new = (partial(mapping, controller, arm) for arm in arms)
                labels = {"scale": scale, "start": start, "kind": kind}
                rows += [
                    labels | propagation_errors(old, new, centre, offsets) for centre in centres
                ]
    return pd.DataFrame(rows)
