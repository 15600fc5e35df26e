"""What the reference study's replicates say in more detail: maps, schedules and widths."""

from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from recalib.study.configuration.lengths import MAPS
from recalib.study.evidence.claims.maps import WIDTHS
from recalib.study.evidence.speedup import iterations_needed
from recalib.study.evidence.verdicts import RATIO
from recalib.study.inference.hierarchy import geometric_student
from recalib.study.inference.intervals import UNKNOWN, Estimate, combined
from recalib.study.inference.measured import ERRORS, KINDS

if TYPE_CHECKING:
    import pandas as pd

FLIPS = 10_000  # of the permutation test
NAMES = {"improved": "improved system", "ritter": "Ritter's"}


def two_maps(reference: "pd.DataFrame") -> list[dict]:
    """By system and iterations: the error with two maps over that with one."""
    rows = []
    for system, iterations in product(NAMES, MAPS):
        one, two = (
            combined(_errors(reference, maps, system)[iterations]) for maps in ("one", "two")
        )
        ratio = geometric_student(two / one)
        about = {"system": NAMES[system], "iterations": iterations}
        rows.append(about | {"ratio": ratio, "verdict": RATIO.verdict(ratio)})
    return rows


def speed_of_two_maps(reference: "pd.DataFrame") -> list[dict]:
    """By system: iterations of two maps over those of one for the same errors.

    The errors are those of one map in the middle of the ladder: of others, one of the two is not
    always within it. `unknown` replicates are not within it either, and left out.
    """
    rows = []
    for system, iterations in product(NAMES, MAPS[1:3]):
        goal = _errors(reference, "one", system)[iterations]
        ladder = np.stack(list(_errors(reference, "two", system).values()), axis=1)
        factors = iterations_needed(np.array(MAPS), ladder, goal) / iterations
        known = np.isfinite(factors)
        estimate = geometric_student(factors[known]) if known.sum() > 1 else UNKNOWN
        about = {"system": NAMES[system], "iterations": iterations}
        rows.append(about | {"factor": estimate, "unknown": int((~known).sum())})
    return rows


def _errors(reference: "pd.DataFrame", maps: str, system: str) -> dict[int, np.ndarray]:
    """Errors (replicate, 2) by number of iterations."""
    return {
        iterations: np.stack(
            [reference[f"{maps}_{system}_{iterations}_{error}"] for error in ERRORS], axis=-1
        )
        for iterations in MAPS
    }


def schedules(reference: "pd.DataFrame") -> list[dict]:
    """By system, law of the rate and n: the error with equal visits over that without."""
    rows = []
    for system, rate, n in product(NAMES, ("linear", "exponential"), (3, 6)):
        ratio = geometric_student(reference[f"schedule_{system}_{rate}_{n}"].to_numpy())
        about = {"system": NAMES[system], "rate": rate, "n": n}
        rows.append(about | {"ratio": ratio, "verdict": RATIO.verdict(ratio)})
    return rows


def width_order(trials: "pd.DataFrame", random: np.random.Generator) -> list[dict]:
    """By map: the permutation test that exchanges g_k and g_kl, over all searches together.

    Trials of the first rounds are looked at. Both widths of such a trial have the same
    distribution. If they mattered alike, their log ratio could have had either sign.
    """
    from scipy.stats import rankdata  # half a second, which only this page needs

    first, rows = trials[trials["round"] == 1], []
    for kind, error, sign in zip(KINDS, ERRORS, (1, -1), strict=True):
        ranks = first.groupby("search")[error].transform(lambda its: rankdata(its) - its.size / 2)
        moved = ranks.to_numpy() * np.log(first[f"{kind}/g_k"] / first[f"{kind}/g_kl"]).to_numpy()
        found = sign * moved.sum()
        exchanged = (random.integers(2, size=(FLIPS, len(moved))) * 2 - 1) @ moved
        p = (1 + (np.abs(exchanged) >= abs(found)).sum()) / (1 + FLIPS)
        rows.append({"claim": WIDTHS[kind].id, "trials": len(moved), "p": p})
    return rows


def one_search(ratios: "pd.Series") -> Estimate:
    """What one search alone would find: the mean, and where 95 % of replicates of ratios lie."""
    from scipy.special import stdtrit

    values = np.log(ratios.to_numpy())
    reach = stdtrit(len(values) - 1, 0.975) * values.std(ddof=1) * np.sqrt(1 + 1 / len(values))
    mean = values.mean()
    return Estimate(*np.exp([mean, mean - reach, mean + reach]).tolist())
