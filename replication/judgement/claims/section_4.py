"""Section 4: positions and orientations apart."""

import numpy as np

from replication.campaign.variants import DOUBLE, TWO_MAPS
from replication.config.switches import IMPROVED
from replication.judgement.claims.claim import Measured, OfSetups, Statement, of_all
from replication.judgement.contrasts import Compromise, Contrast, Error, Remaining
from replication.judgement.evidence import Evidence
from replication.judgement.findings import Finding, Number, number
from replication.judgement.hierarchy import student
from replication.judgement.verdicts import RATIO, of_share, share_interval
from replication.training.measured import KINDS

WEAK = 0.1  # ratio to the direct effect: *slowly* means an order of magnitude
POSES = 0.95
BOX = 2  # size of the box relative to the workspace
RISES = RATIO._replace(below=False)  # ratios above 1 support the paper
ONE, TWO = "Ritter's one map", "Ritter's two maps"
ONE_TWO = "Ritter's algorithm"


def weak_coupling(statement: Statement, evidence: Evidence) -> Finding:
    """In how many setups the off-diagonal blocks of the mapping's Jacobian are small."""
    table = evidence.table("workflow/campaign/untrained.csv")
    worst = table.groupby("setup")[list(KINDS)].max().max(axis=1)
    holds, setups = int((worst <= WEAK).sum()), len(worst)
    shares = Number(
        name="share of setups with weak coupling",
        system="",
        value=holds / setups,
        interval=share_interval(holds, setups),
    )
    middle = number(
        f"norm of off-diagonal / diagonal blocks, {100 * POSES:g} % quantile",
        "",
        student(np.log(worst.to_numpy())),
    )
    by_robot = worst.groupby(evidence.levels()["robot"]).median().round(3)
    text = ", ".join(f"{robot} {value:g}" for robot, value in by_robot.items())
    note = f"Coupling is weak in {holds} of {setups} setups. Medians by robot: {text}."
    return statement.finding(of_share(holds, setups), shares, middle, note=note)


def nearness(statement: Statement, evidence: Evidence) -> Finding:
    """The coupling in a larger box, and near to singularities."""
    table = evidence.mapping("nearness")
    table = table.assign(coupling=table[list(KINDS)].max(axis=1))
    own, larger = table[table["size"] == 1], table[table["size"] == BOX]
    most, least = (its.groupby("draw")["coupling"].quantile(POSES) for its in (larger, own))
    middle = larger.groupby("draw")["condition"].transform("median")
    near, far = (
        its.groupby("draw")["coupling"].median()
        for its in (larger[larger["condition"] > middle], larger[larger["condition"] <= middle])
    )
    estimates = {
        "coupling in a box twice as long / in the workspace": student(np.log(most / least)),
        "coupling near / far from singularities": student(np.log(near / far)),
    }
    note = (
        f"Intervals over {table['draw'].nunique()} draws of poses in the reference study. Size and"
        " distance from singularities were not varied independently."
    )
    numbers = [number(name, "", its) for name, its in estimates.items()]
    verdict = of_all(*map(RISES.of_interval, estimates.values()))
    return statement.finding(verdict, *numbers, note=note)


def claims(iterations: int, late: int) -> list[OfSetups | Measured]:
    """The claims of the section: `iterations` of Figure 1, `late` ones to compare Ritter's maps."""

    def remaining(variant: str, error: Error = "both") -> Remaining:
        return Remaining(variant, late, error)

    def small(net: str, error: Error) -> Remaining:
        return remaining(f"small_{net.removesuffix('s')}_for_{error}", error)

    orders = {
        "position": (
            "one with a narrow g_k and a wide g_kl to compute only position commands",
            "narrow neighbourhoods of positions and wide ones of orientations",
        ),
        "orientation": (
            "another with a wide g_k and a narrow g_kl to compute only orientation commands",
            "wide neighbourhoods of positions and narrow ones of orientations",
        ),
    }
    cells = {
        "position": (
            "the position network needs less units in the supernet",
            ("supernet", "subnets"),
        ),
        "orientation": (
            "the orientation network saves neurons at the subnet level",
            ("subnets", "supernet"),
        ),
    }
    errors: tuple[Error, ...] = "position", "orientation"
    found: list[OfSetups | Measured] = [
        Measured(
            "weak-coupling",
            "changes in position coordinates influence very slowly the orientation commands, and"
            " the same can be said about orientation coordinates with respect to position commands",
            "Positions hardly influence orientation commands, nor the reverse.",
            f"In every setup, at {100 * POSES:g} % of poses, the off-diagonal blocks of the true"
            " mapping's Jacobian have at most a tenth of the norm of the diagonal ones.",
            "*Slowly* is an order of magnitude, in half-ranges of the workspace.",
            judge_=weak_coupling,
        ),
        Measured(
            "weak-coupling-reason",
            "Due to the characteristics of the workspace used (far from singularities and of small"
            " size relative to that of the robot)",
            "This decoupling arises because the workspace is small and far from singularities.",
            f"The cross effect at {100 * POSES:g} % of poses rises in a box twice as long along"
            " each axis of positions. In that box it is larger, in the median, at the half of the"
            " poses with the larger condition numbers.",
            "Units stay those of the workspace, so a larger box changes only where poses are.",
            judge_=nearness,
        ),
        OfSetups(
            "large-neighbourhoods",
            "too large neighborhoods in the position coordinates space are counterproductive to"
            " learn position commands",
            "Too wide neighbourhoods of positions hurt position commands.",
            "The position error as tuned is below that with the position map's g_k kept as wide as"
            " the workspace, and all else tuned anew.",
            "No neighbourhood needs to be wider than the workspace.",
            name="position error with tuned / with wide neighbourhoods of positions",
            system=TWO,
            estimand=Contrast(
                remaining("two_maps_for_position", "position"),
                remaining("two_maps_for_position_wide", "position"),
            ),
        ),
        OfSetups(
            "no-good-solution",
            "there is no good solution to these contradictory interests within Ritter et al.'s"
            " framework",
            "One map cannot serve positions and orientations at once.",
            "The larger share of both errors, tuned for both, is above the larger one of the"
            " shares that the map leaves if it is tuned for each error alone.",
            "If both errors had the same optimum, the ratio would be 1.",
            name="error if tuned for both / for each error alone",
            system=ONE,
            estimand=Compromise(
                remaining(DOUBLE),
                remaining("one_map_for_position", "position"),
                remaining("one_map_for_orientation", "orientation"),
            ),
            comparison=RISES,
        ),
        OfSetups(
            "separate-maps",
            "This modification leads to a significant increase in learning speed.",
            "Two maps, one for positions and one for orientations, learn faster than one.",
            f"After {late:,} iterations, Ritter's two maps leave a smaller error than his one map"
            " with as many cells, each tuned by itself.",
            "Section 4 speaks of Ritter's framework. After 200 iterations most of his error"
            " remains, too much to show a difference.",
            name="error with two maps / with one",
            system=ONE_TWO,
            estimand=Contrast(remaining(TWO_MAPS), remaining(DOUBLE)),
            secondary={
                ("error with two maps / with one, 200 iterations", ONE_TWO): Contrast(
                    Remaining(TWO_MAPS, iterations), Remaining(DOUBLE, iterations)
                ),
                ("error with two maps / with one", "improved system"): Contrast(
                    Remaining(IMPROVED, iterations), Remaining("improved_single_map", iterations)
                ),
            },
        ),
    ]
    for error in errors:
        words, widths = orders[error]
        found.append(
            OfSetups(
                f"widths-{error}",
                words,
                f"The {error} map needs {widths}.",
                f"After {late:,} iterations, the {error} error of two maps is smaller if the"
                f" {error} map's final widths have the paper's order than in reverse order. The"
                " other error stays within what a search for both finds.",
                "Both orders are tuned by themselves, and contain equal widths.",
                name=f"{error} error in the paper's order / in reverse",
                system=TWO,
                estimand=Contrast(
                    remaining(f"two_maps_for_{error}_paper", error),
                    remaining(f"two_maps_for_{error}_reverse", error),
                ),
            )
        )
    for error in errors:
        words, (net, other) = cells[error]
        found.append(
            OfSetups(
                f"cells-{error}",
                words,
                f"The {error} map needs fewer cells in the {net}.",
                f"After {late:,} iterations, the {error} error of two maps with 2 x 2 x 2 cells in"
                f" the {net} is below that with 2 x 2 x 2 cells in the {other}.",
                "A map that needs fewer cells in a net loses less if it has fewer. Above 1, the"
                " sentence holds with supernet and subnets exchanged.",
                name=f"{error} error with fewer cells in the {net} / in the {other}",
                system=TWO,
                estimand=Contrast(small(net, error), small(other, error)),
            )
        )
    return found
