"""How many iterations a learner needs for a pair of errors, and how many times another's."""

import numpy as np

from recalib.study.statistics import LEVEL, RESAMPLES, Estimate


def iterations_needed(rungs: np.ndarray, errors: np.ndarray, target: np.ndarray) -> float:
    """The least number of iterations after which both errors are within the target.

    Args:
        rungs: (rung,) ascending numbers of iterations, each with a training tuned for it.
        errors: (rung, 2) mean final errors.
        target: (2,) errors to reach.

    Returns the number, interpolated on logarithmic scales between the last rung that misses and the
    first that reaches; NaN where the first rung reaches already, since fewer iterations might have,
    and infinity where none does.
    """
    worse = np.max(errors / target, axis=1)
    reached = np.flatnonzero(worse <= 1)
    if not len(reached):
        return np.inf
    first = reached[0]
    if first == 0:
        return np.nan
    before, after = np.log(worse[first - 1]), np.log(worse[first])
    share = before / (before - after)
    return float(np.exp(np.log(rungs[first - 1]) + share * np.log(rungs[first] / rungs[first - 1])))


def speed_up(
    slow: dict[int, np.ndarray], fast: dict[int, np.ndarray], target, random: np.random.Generator
) -> Estimate:
    """Iterations that the slow learner needs over those of the fast one, bootstrapped over seeds.

    Args:
        slow, fast: for each rung of iterations, final errors (seed, 2).
        target: a pair of errors (2,), or a rung of the fast learner: the errors that it reaches.
        random: of the interval.

    NaN where the first rung of a ladder is within the target already, or the fast learner does not
    get there. An infinite bound says that the slow learner does not get there on its rungs, so
    that it needs more than the highest of them: nothing else is known.
    """

    def ratio(pick) -> float:
        means = [
            {rung: pick(errors).mean(axis=0) for rung, errors in ladder.items()}
            for ladder in (slow, fast)
        ]
        goal = means[1][target] if np.isscalar(target) else np.asarray(target)
        needed = [
            iterations_needed(np.array(list(m)), np.array(list(m.values())), goal) for m in means
        ]
        if np.isscalar(target):
            needed[1] = float(target)
        return needed[0] / needed[1] if needed[1] < np.inf else np.nan

    resampled = [
        ratio(lambda errors: errors[random.integers(len(errors), size=len(errors))])
        for _ in range(RESAMPLES // 4)
    ]
    low, high = np.quantile(resampled, [(1 - LEVEL) / 2, (1 + LEVEL) / 2], method="nearest")
    return Estimate(ratio(lambda errors: errors), float(low), float(high))
