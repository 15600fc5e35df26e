"""Where the results of a study lie: the one home of their paths, for all who make or read them."""

from dataclasses import dataclass
from pathlib import Path

SHIPPED = "replication"  # the name of the study that writes README, docs and figures/
RESULTS = "results"
DESIGN = "workflow/universes/design.csv"  # the factors of each universe
OUTCOMES = "workflow/universes/outcomes.csv"  # what was measured in each, shipped
SEARCHED = "workflow/search"  # samples of the search that are shipped


def root_of(study: str) -> str:
    """The folder of the results of the study of this name."""
    return RESULTS if study == SHIPPED else f"{RESULTS}/studies/{study}"


@dataclass(frozen=True)
class Layout:
    """The paths below a study's folder of results; patterns of rules where that is `{root}`.

    Args:
        root: the folder.
    """

    root: str

    @property
    def summary(self) -> str:
        """Initial and final errors of every training."""
        return f"{self.root}/summary.csv"

    @property
    def claims(self) -> str:
        """The judged claims."""
        return f"{self.root}/claims.json"

    @property
    def outcome(self) -> str:
        """What came out, for a terminal."""
        return f"{self.root}/outcome.txt"

    @property
    def coverage(self) -> str:
        """How often intervals held, when the study was repeated within itself."""
        return f"{self.root}/coverage.csv"

    @property
    def check(self) -> str:
        """The check of the final errors."""
        return f"{self.root}/check.txt"

    @property
    def expected(self) -> str:
        """Bands for the check, as this study's results propose them."""
        return f"{self.root}/expected.csv"

    @property
    def bench(self) -> str:
        """The speed of moves and trainings."""
        return f"{self.root}/bench.txt"

    @property
    def benchmark(self) -> str:
        """Errors of every learner against moves."""
        return f"{self.root}/benchmark.csv"

    @property
    def benchmark_moves(self) -> str:
        """Moves to each threshold."""
        return f"{self.root}/benchmark_moves.csv"

    @property
    def benchmark_seconds(self) -> str:
        """Computing times, which differ from run to run."""
        return f"{self.root}/benchmark_seconds.csv"

    @property
    def real(self) -> str:
        """Errors on the real arm."""
        return f"{self.root}/real.csv"

    @property
    def design(self) -> str:
        """The design of the multiverse."""
        return f"{self.root}/universes/design.csv"

    def universe(self, number: str) -> str:
        """What was measured in a universe."""
        return f"{self.root}/chunks/universes/{number}.csv"

    @property
    def outcomes(self) -> str:
        """What was measured in every universe."""
        return f"{self.root}/universes/outcomes.csv"

    def assignments(self, robot: str, suffix: str = ".parquet") -> str:
        """Initial errors of every assignment of the paper's damage; .json: the one that is used."""
        return f"{self.root}/assignments/{robot}{suffix}"

    def scenario(self, scenario: str) -> str:
        """A damage as resolved, with its robot: all that a plant is made of."""
        return f"{self.root}/scenarios/{scenario}.json"

    def chunk(self, scenario: str, learner: str, chunk: str, suffix: str = ".parquet") -> str:
        """Some seeds of a training: their history, or (.npz) what they learned."""
        return f"{self.root}/chunks/runs/{scenario}/{learner}.{chunk}{suffix}"

    def history(self, scenario: str, learner: str) -> str:
        """Every measurement of a training."""
        return f"{self.root}/runs/{scenario}/{learner}.parquet"

    def learned(self, scenario: str, learner: str) -> str:
        """What a training learned."""
        return f"{self.root}/runs/{scenario}/{learner}.npz"

    def search_chunk(self, training: str, chunk: str) -> str:
        """Some of the searches for a training."""
        return f"{self.root}/chunks/search/{training}.{chunk}.csv"

    def searched(self, training: str) -> str:
        """All trials of the searches for a training."""
        return f"{self.root}/search/{training}.csv"

    def ensemble_chunk(self, series: str, learner: str, chunk: str) -> str:
        """Some robots of a series of other damages."""
        return f"{self.root}/chunks/ensemble/{series}.{learner}.{chunk}.parquet"

    def ensemble(self, series: str, learner: str) -> str:
        """A series of other damages."""
        return f"{self.root}/ensemble/{series}.{learner}.parquet"

    def mapping(self, study: str) -> str:
        """A measurement of mapping: coupling, propagation, quantisation, visits, replay."""
        return f"{self.root}/mapping/{study}.parquet"

    def benchmark_batch(self, learner: str, batch: str) -> str:
        """A learner's histories on scenarios that share a job."""
        return f"{self.root}/chunks/benchmark/{learner}.{batch}.parquet"

    def real_data(self, part: str) -> str:
        """A recording of the real arm: fit or test."""
        return f"{self.root}/real/{part}.csv"

    def real_run(self, learner: str) -> str:
        """A learner's errors from recorded poses of the real arm."""
        return f"{self.root}/real/runs/{learner}.csv"

    def real_twin(self, learner: str) -> str:
        """A learner's errors on the twin of the real arm."""
        return f"{self.root}/real/twin/{learner}.csv"

    def figure(self, figure: str, suffix: str = ".svg") -> str:
        """A figure, before it is published."""
        return f"{self.root}/figures/{figure}{suffix}"

    def page(self, page: str) -> str:
        """A page such as README.md, before it is published."""
        return f"{self.root}/pages/{page}"

    def report_page(self, page: str, suffix: str = ".html") -> str:
        """A page of the report."""
        return f"{self.root}/report/{page}{suffix}"

    def recording(self, name: str) -> str:
        """A recording, named as `Plan.recording` has it."""
        return f"{self.root}/recordings/{name}.rrd"

    @property
    def name(self) -> str:
        """The study's name, for titles."""
        return Path(self.root).name if self.root != RESULTS else SHIPPED
