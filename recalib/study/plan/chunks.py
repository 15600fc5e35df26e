"""How work is cut into jobs."""

from recalib.study.configuration.study import Study
from recalib.study.plan.trainings import training


def chunks(total: int, size: int) -> list[int]:
    """The numbers of the chunks into which so many seeds, searches or robots are cut."""
    return list(range(-(-total // size)))


def bounds(chunk: int | str, total: int, size: int) -> dict[str, int]:
    """The `first` of a chunk, and `last`, one past its last."""
    first = int(chunk) * size
    return {"first": first, "last": min(first + size, total)}


def searches_per_job(study: Study, learner: str) -> int:
    """How many searches for a learner one job does."""
    return max(1, study.search.iterations_per_job // training(study, learner).iterations)
