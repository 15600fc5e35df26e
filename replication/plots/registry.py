"""Every figure: what it reads, when it is drawn, and where."""

from collections.abc import Callable, Collection, Mapping
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple

from replication.config.shipped import FACTORS, REFERENCE
from replication.config.study import Study
from replication.judgement.needs import Request
from replication.judgement.results import Evidence

if TYPE_CHECKING:
    import matplotlib.figure


class Figure(NamedTuple):
    """A figure.

    Attributes:
        part: of a study that draws it: its trainings where they suffice, its evidence, or a target
            of its own. An idea is explained once, with the shipped study; figures/ideas.py draws
            those that show no result.
        module: beside this one, whose function of the figure's name draws it. Imported when that is
            asked for: the workflow declares figures, and each job draws one.
        needs: what it reads; see `replication.judgement.needs`.
    """

    part: Literal["trainings", "evidence", "benchmark", "real", "ideas"]
    module: str
    needs: str

    @property
    def home(self) -> str:
        """The module's whole name."""
        return f"{__package__}.{self.module}"


HISTORY = "runs/{scenario}/{improved}.parquet"
SETUPS = "outcomes horizon?"  # the horizon takes hours, and may not be there
FIGURES: Mapping[str, Figure] = {
    "figure1": Figure("trainings", "learning", f"{HISTORY} scenarios/{{scenario}}.json tests"),
    "figure2": Figure(
        "trainings",
        "learning",
        "runs/{scenario}/{learners}.parquet runs/{scenario}/{compared}.parquet",
    ),
    "figure3": Figure("trainings", "learning", "runs/{scenarios}/{learners}.parquet"),
    "figure4": Figure(
        "trainings",
        "changes",
        f"{HISTORY} runs/{{scenario}}/{{short}}.parquet runs/{{scenario}}/{{switched}}.parquet"
        f" runs/{{scenario}}/{{beside}}.parquet {REFERENCE}? seed iterations",
    ),
    "figure5": Figure("evidence", "mapping", "mapping/coupling.parquet scenarios"),
    "figure6": Figure(
        "evidence", "searched", "search/{improved}.csv search/{ritter}.csv iterations rough_trials"
    ),
    "figure7": Figure("evidence", "mapping", "mapping/propagation.parquet balls radius"),
    "figure8": Figure("evidence", "mapping", "mapping/visits.parquet"),
    "figure9": Figure(
        "trainings", "ladders", f"runs/{{scenario}}/{{ladder}}.parquet {HISTORY} seed iterations"
    ),
    "figure10": Figure(
        "evidence", "mapping", "assignments/{robot}.parquet published assignment_poses"
    ),
    "figure11": Figure(
        "evidence",
        "elsewhere",
        "ensemble/assignments.improved.parquet ensemble/scaled.improved.parquet"
        " ensemble/assignments.ritter.parquet runs/{elsewhere}/{learners}.parquet",
    ),
    "figure12": Figure("benchmark", "benchmark", "benchmark.csv"),
    "figure13": Figure("real", "benchmark", "real.csv real_robot published_mm"),
    "figure14": Figure("evidence", "universes", f"{SETUPS} claims.json"),
    "figure15": Figure("evidence", "choices", f"{SETUPS} {FACTORS} seed"),
    "multiverse": Figure("ideas", "multiverse", f"outcomes {FACTORS}"),
}


def draw(figure: str, evidence: Evidence) -> "matplotlib.figure.Figure":
    """A figure from what it declares; `style.STYLE` is for the caller to set."""
    return getattr(import_module(FIGURES[figure].home), figure)(evidence)


def publish(figure: str, evidence: Evidence, svg: Path, png: Path) -> None:
    """Draw a figure into files."""
    from replication.plots.style import STYLE, plt, save

    with plt.rc_context(STYLE):
        save(draw(figure, evidence), svg, png)


def drawn(study: Study, request: Callable[[], Request]) -> list[str]:
    """The figures of a default run of this study: those for which it has what they need."""
    return possible(["trainings", "evidence"][: 1 + study.experiments.evidence], request)


def possible(parts: Collection[str], request: Callable[[], Request]) -> list[str]:
    """The figures of these parts of a study for which it has what they need."""
    return [
        name
        for name, figure in FIGURES.items()
        if figure.part in parts and not request().read(figure.needs).lacking
    ]
