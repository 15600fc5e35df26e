"""How work is cut into jobs."""

from recalib.study.configuration.study import Study
from recalib.study.plan.trainings import scenario_of, training

SIDE_BY_SIDE = 5  # scenarios in a job: many robots solved in one call take half the time a move


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


def batches(study: Study) -> dict[str, list[str]]:
    """The benchmark's scenarios that share a job, and so a robot, by their batch."""
    by_robot: dict[str, list[str]] = {}
    for name in study.benchmark.scenarios:
        by_robot.setdefault(scenario_of(study, name)[1], []).append(name)
    shared = [
        own[first : first + SIDE_BY_SIDE]
        for own in by_robot.values()
        for first in range(0, len(own), SIDE_BY_SIDE)
    ]
    return {str(number): batch for number, batch in enumerate(shared)}
