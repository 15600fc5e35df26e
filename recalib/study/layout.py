"""Where the results of a study lie: the one home of their paths, for all who make or read them."""

from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path

SHIPPED = "replication"  # the name of the study that writes README, docs and figures/
RESULTS = "results"
FIRST = "workflow/universes/first"  # the first campaign: its design, and what was measured
SECOND = "workflow/universes/second"  # the second one, as shipped
DESIGN = f"{SECOND}/design.csv"  # the factors of each universe
REFERENCE = f"{SECOND}/reference.csv"  # the reference study, measured like a universe
EFFORTS = f"{SECOND}/efforts.csv"  # its trainings for the factor of 70, by effort
POWER = f"{SECOND}/power.csv"  # what the campaign can find
DEVIATIONS = "workflow/deviations.yaml"  # what changed after a result had been seen
SEARCHED = "workflow/search"  # samples of the search that are shipped


def root_of(study: str) -> str:
    """The folder of the results of the study of this name."""
    return RESULTS if study == SHIPPED else f"{RESULTS}/studies/{study}"


PIECES = {"outcomes": 32, "horizon": 8}  # setups: what two cores measure in at most an hour


def pieces(table: str, setups: int, root: str = SECOND) -> list[str]:
    """The pieces of a table of the second campaign: outcomes or horizon of so many setups."""
    return [f"{root}/{table}_{number}.csv" for number in range(-(-setups // PIECES[table]))]


@dataclass(frozen=True)
class Layout:
    """The paths below a study's folder of results; patterns of rules where that is `{root}`.

    Args:
        root: the folder.
    """

    root: str

    def shipped(self, path: str) -> str:
        """A file that lies in the project whose results these are."""
        return str(Path(*takewhile(lambda part: part != RESULTS, Path(self.root).parts), path))

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

    def campaign(self, table: str) -> str:
        """A table of the second campaign before it is shipped."""
        return f"{self.root}/universes/{table}.csv"

    def campaign_chunk(self, table: str, number: str) -> str:
        """What was measured in a universe, in a replicate of the reference study or a training."""
        return f"{self.root}/chunks/universes/{table}/{number}.csv"

    def campaign_pieces(self, table: str, setups: int) -> list[str]:
        """All universes, in pieces of work of at most an hour each."""
        return pieces(table, setups, f"{self.root}/universes")

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
        """A measurement without a learner: coupling, propagation, quantisation, visits, replay."""
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
