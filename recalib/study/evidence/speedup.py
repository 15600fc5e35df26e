"""How many iterations a learner needs for a pair of errors, and how many times another's."""

from collections.abc import Iterable, Mapping

import numpy as np

from recalib.study.inference.intervals import Draws, Estimate


def iterations_needed(rungs: np.ndarray, errors: np.ndarray, target: np.ndarray) -> np.ndarray:
    """The least number of iterations (...) after which both errors are within the target.

    Args:
        rungs: (rung,) ascending numbers of iterations, each with a training tuned for it.
        errors: (..., rung, 2) mean final errors.
        target: (..., 2) errors to reach.

    Interpolated on logarithmic scales between the last rung above the target and the first that
    reaches it; NaN where the first rung reaches it already, since fewer iterations might have, and
    infinity where none does.
    """
    worse = np.log((errors / np.asarray(target)[..., None, :]).max(axis=-1))
    reached = worse <= 0
    after = np.maximum(reached.argmax(axis=-1), min(1, len(rungs) - 1))
    before = after - 1
    above, within = (
        np.take_along_axis(worse, rung[..., None], axis=-1)[..., 0] for rung in (before, after)
    )
    grid = np.log(np.asarray(rungs, dtype=float))
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.clip(above / (above - within), 0, 1)
    needed = np.exp(grid[before] + share * (grid[after] - grid[before]))
    needed = np.where(reached.any(axis=-1), needed, np.inf)
    return np.where(reached[..., 0], np.nan, needed)


def speed_up(
    slow: Mapping[int, np.ndarray],
    fast: Mapping[int, np.ndarray],
    targets: Iterable[int | np.ndarray],
    random: np.random.Generator,
) -> list[Estimate]:
    """Iterations that the slow learner needs over those of the fast one, for each target.

    Args:
        slow, fast: for each rung of iterations, final errors (search, seed, 2).
        targets: pairs of errors (2,), or rungs of the fast learner: the errors that it reaches.
        random: of the intervals.

    NaN where the first rung of a ladder is within the target already, or the fast learner does not
    get there: all that is known is that the factor is not large. So an interval begins at 0 where
    that happens in its studies. An infinite bound says that the slow learner does not get there on
    its rungs, so that it needs more than the highest of them: nothing else is known.
    """
    draws = Draws(random, *slow.values(), *fast.values())
    means = [
        np.stack([draws.means(errors) for errors in ladder.values()], axis=1)
        for ladder in (slow, fast)
    ]

    def estimate(target: int | np.ndarray) -> Estimate:
        if isinstance(target, int):
            goal, quick = means[1][:, list(fast).index(target)], np.array(float(target))
        else:
            goal = np.asarray(target)
            quick = iterations_needed(np.array(list(fast)), means[1], goal)
            quick = np.where(np.isinf(quick), np.nan, quick)
        factors = iterations_needed(np.array(list(slow)), means[0], goal) / quick
        if not np.isnan(factors[0]):
            factors[np.isnan(factors)] = 0
        return draws.estimate(factors)

    return [estimate(target) for target in targets]
