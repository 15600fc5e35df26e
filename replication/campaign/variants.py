"""The variants: algorithms that are each tuned by themselves, and compared in every setup.

A search minimises the error that a contrast is about. For learning, that is the larger remaining
share of both errors. For a claim about the position map, it is the position error, while the
orientation error stays within what the search for both has found; and the reverse.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

from recalib.learners.rules import Rules
from replication.config.study import Study
from replication.config.switches import IMPROVED, RITTER, SWITCHES
from replication.training.tuned import rules_of

Target = Literal["both", "position", "orientation"]
Order = Literal["free", "paper", "reverse"]  # of the widths of the map that a claim is about

DOUBLE = "ritter_double"
TWO_MAPS = SWITCHES[0].added
WORKSPACE = 2.0  # wide: no neighbourhood need be wider
SMALL = (2, 2, 2)  # cells of a net that is spared some
FEW = 2000  # iterations: more teach nothing new where increments of theta are shared
DRASTIC = 3.0  # times the paper's encoder shifts; links are shortened as in the paper


@dataclass(frozen=True)
class Variant:
    """An algorithm that is tuned by itself.

    Attributes:
        rules: of the learner, before the conventions of a setup.
        lengths: iterations for which it is tuned in every setup, ascending.
        improved: whether it is of the improved system's family, or of Ritter's.
        target: the error that its search minimises.
        held: the variant whose search for both errors says what the other error may be.
        order: of the final widths of the map of `target`.
        constant: neighbourhoods whose width is given, and does not fall.
        radial: whether it has radial units without Jacobians.
        random: whether theta starts from random values, not from the identity.
        rough: whether its search is very rough.
        damage: factor of the encoder shifts.
        until_reached: lengths that are tuned until one reaches the improved system's errors.
        at_home: more lengths in the reference study.
    """

    rules: Rules
    lengths: tuple[int, ...]
    improved: bool = False
    target: Target = "both"
    held: str | None = None
    order: Order = "free"
    constant: Mapping[str, float] = field(default_factory=dict)
    radial: bool = False
    random: bool = False
    rough: bool = False
    damage: float = 1.0
    until_reached: tuple[int, ...] = ()
    at_home: tuple[int, ...] = ()


def variants(study: Study) -> dict[str, Variant]:
    """All of them by name, each after those that it needs."""
    plan, own = study.campaign, (study.experiments.iterations,)
    known = {name: rules_of(its) for name, its in study.every_learner.items()}
    late, improved, ritter = (plan.late,), known[IMPROVED], known[RITTER]
    rungs = {*own, *late, *plan.reference_rungs}
    few = tuple(sorted(rung for rung in rungs if rung <= FEW))
    many = tuple(sorted(rung for rung in rungs if rung >= own[0]))
    two_maps, double = known[TWO_MAPS], rules_of(study.doubled(study.learners[RITTER]))
    values = replace(improved, theta_increments=False, jacobian_increments=False)
    found = {IMPROVED: Variant(improved, own, True, at_home=few)}
    found |= {switch.without: Variant(known[switch.without], own, True) for switch in SWITCHES}
    found |= {
        "improved_values": Variant(values, own, True),
        "improved_rough": Variant(improved, own, True, rough=True),
        "improved_drastic": Variant(improved, own, True, damage=DRASTIC),
        "improved_values_drastic": Variant(values, own, True, damage=DRASTIC),
        RITTER: Variant(ritter, own + late, at_home=many),
        DOUBLE: Variant(double, own + late, until_reached=plan.rungs, at_home=many),
        "ritter_random_start": Variant(ritter, own, random=True),
        TWO_MAPS: Variant(two_maps, own + late, at_home=many),
    }
    found |= {switch.added: Variant(known[switch.added], own) for switch in SWITCHES[1:]}
    found |= {
        "radial_increments": Variant(improved, own, True, radial=True),
        "radial_values": Variant(values, own, True, radial=True),
    }
    small = {
        "small_supernet": replace(two_maps, supernet=SMALL),
        "small_subnet": replace(two_maps, subnet=SMALL),
    }
    found |= {name: Variant(rules, late) for name, rules in small.items()}
    targets: tuple[Target, ...] = "position", "orientation"
    for target in targets:
        its = Variant(two_maps, late, target=target, held=TWO_MAPS)
        found |= {
            f"one_map_for_{target}": Variant(double, late, target=target),
            f"two_maps_for_{target}": its,
            f"two_maps_for_{target}_paper": replace(its, order="paper"),
            f"two_maps_for_{target}_reverse": replace(its, order="reverse"),
        }
        found |= {
            f"{name}_for_{target}": replace(its, rules=rules, held=name)
            for name, rules in small.items()
        }
    found["two_maps_for_position_wide"] = replace(
        found["two_maps_for_position"], constant={"position_g_k": WORKSPACE}
    )
    # steps from Ritter's map to the improved system, with Ritter's schedule until the last one
    steps = {
        "two_maps_theta": replace(two_maps, theta_increments=True),
        "two_maps_jacobian": replace(two_maps, jacobian_increments=True),
        "two_maps_increments": replace(two_maps, theta_increments=True, jacobian_increments=True),
    }
    return found | {
        name: Variant(its, (), at_home=few if its.theta_increments else many)
        for name, its in steps.items()
    }


def needed(variant: Variant) -> list[str]:
    """The variants whose rows a variant needs."""
    return [
        *([variant.held] if variant.held else []),
        *([IMPROVED] if variant.until_reached else []),
    ]


def lengths(variant: Variant, setup: int) -> tuple[int, ...]:
    """Iterations for which a variant is tuned in a setup, ascending."""
    return tuple(sorted({*variant.lengths, *(variant.at_home if setup == 0 else ())}))
