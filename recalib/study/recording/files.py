"""A recording from the files of an experiment: its scenario, its searches and its trainings."""

from pathlib import Path

from recalib.interfaces import Learner
from recalib.study.entrants import make_peer
from recalib.study.experiments.settings import build_tuned
from recalib.study.measured import errors_of
from recalib.study.plants import Resolved
from recalib.study.recordings import Recording
from recalib.study.statistics import typical


def record(
    rrd: Path, recording: Recording, scenario: Path, samples: list[Path], histories: list[Path]
) -> None:
    """Write the recording of a scenario from files: a run of a typical search.

    It is that of the first of the paper's learners. See `writing.write_recording`.

    Args:
        rrd: its file.
        recording: what is recorded.
        scenario: file of the scenario as resolved.
        samples: for each of its learners of the paper, the file of the search for it.
        histories: for each of them, the file of its training.
    """
    import pandas as pd  # a quarter of a second: no start waits for it

    resolved = Resolved.read(scenario)
    papers = recording.papers()
    tables = dict(zip(papers, (pd.read_parquet(history) for history in histories), strict=True))
    left = errors_of(next(iter(tables.values())))
    seed = typical(left) * left.shape[1]  # the first one of that search
    measured = {name: table[table["seed"] == seed] for name, table in tables.items()}
    searched = dict(zip(papers, samples, strict=True))
    learners: dict[str, Learner] = {
        name: build_tuned(learner, searched[name], measured[name]["search"].unique())
        if learner
        else make_peer(name, 1, resolved.controller())
        for name, learner in recording.learners.items()
    }
    # Rerun takes half a second: what is broken in the files is said without waiting for it.
    from recalib.study.recording.writing import write_recording

    write_recording(rrd, recording, resolved, learners, measured, seed)
