"""Every figure: what it reads, when it is drawn, and where."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from importlib import import_module
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from recalib.study.configuration.study import Study
from recalib.study.configuration.switches import IMPROVED, RITTER, SWITCHES
from recalib.study.evidence.claims.changes import ask_for
from recalib.study.evidence.factor import CELLS
from recalib.study.evidence.needs import Request
from recalib.study.evidence.results import Evidence
from recalib.study.shipped import REFERENCE

if TYPE_CHECKING:
    import matplotlib.figure


@dataclass(frozen=True)
class Figure:
    """A figure.

    Attributes:
        needs: asks for what it reads.
        part: of a study that draws it: its trainings where they suffice, its evidence, or a target
            of its own. An idea is explained once, with the shipped study.
        module: beside this one, whose function of the figure's name draws it. Imported when that is
            asked for: the workflow declares figures, and each job draws one.
    """

    needs: Callable[[Request], None]
    part: Literal["trainings", "evidence", "benchmark", "real", "ideas"]
    module: str

    @property
    def home(self) -> str:
        """The module's whole name."""
        return f"{__package__}.{self.module}"


def _figure1(ask: Request) -> None:
    ask.history(ask.fact("improved"))
    ask.scenario()
    ask.fact("tests")


def _figure2(ask: Request) -> None:
    for learner in (*ask.fact("learners"), *ask.fact("compared")):
        ask.history(learner)


def _figure3(ask: Request) -> None:
    for scenario, learner in product(ask.fact("scenarios"), ask.fact("learners")):
        ask.history(learner, scenario)


def _figure4(ask: Request) -> None:
    own = ask.fact("switches"), ask.fact("beside")
    if not any(own):
        ask.lack("experiments.switches: true")
    if own[0] and ask.fact("shipped"):
        ask.shipped(REFERENCE)
    ask_for(ask, SWITCHES[1:] if own[0] else ())
    for learner in own[1] or ():
        ask.history(learner)
    ask.fact("iterations")


def _figure5(ask: Request) -> None:
    ask.files("mapping/coupling.parquet")
    ask.fact("scenarios")


def _figure6(ask: Request) -> None:
    for role in ("improved", "ritter"):
        ask.sample(ask.fact(role))
    ask.facts("iterations", "rough_trials")


def _figure7(ask: Request) -> None:
    ask.files("mapping/propagation.parquet")
    ask.facts("balls", "radius")


def _figure8(ask: Request) -> None:
    ask.files("mapping/visits.parquet")


def _figure9(ask: Request) -> None:
    for learner in (IMPROVED, *CELLS):
        ask.ladder(learner)
    ask.history(ask.fact("improved"))
    ask.fact("seed")
    own = ask.fact("iterations")
    if own not in ask.study.experiments.ladder.get(IMPROVED, ()):
        ask.lack(f"experiments.ladder.{IMPROVED}: {own}")


def _figure10(ask: Request) -> None:
    ask.assignments()
    ask.facts("published", "assignment_poses")


def _figure11(ask: Request) -> None:
    ask.ensemble(IMPROVED, "assignments")
    ask.ensemble(IMPROVED, "scaled")
    ask.ensemble(RITTER, "assignments")
    for scenario, learner in product(ask.fact("elsewhere").values(), ask.fact("learners")):
        ask.history(learner, scenario)


def _figure12(ask: Request) -> None:
    ask.files("benchmark.csv")


def _figure13(ask: Request) -> None:
    ask.files("real.csv")
    ask.facts("real_robot", "published_mm")


def _universes(ask: Request) -> None:
    _multiverse(ask)
    ask.setups("horizon")  # which takes hours, and may not be there


def _figure14(ask: Request) -> None:
    _universes(ask)
    ask.files("claims.json")


def _figure15(ask: Request) -> None:
    _universes(ask)
    ask.fact("seed")


def _multiverse(ask: Request) -> None:
    if not ask.setups("outcomes"):
        ask.lack("universes: outcomes")


def _nothing(ask: Request) -> None:
    """Of a picture that shows no result."""


FIGURES: Mapping[str, Figure] = {
    "figure1": Figure(_figure1, "trainings", "learning"),
    "figure2": Figure(_figure2, "trainings", "learning"),
    "figure3": Figure(_figure3, "trainings", "learning"),
    "figure4": Figure(_figure4, "trainings", "changes"),
    "figure5": Figure(_figure5, "evidence", "mapping"),
    "figure6": Figure(_figure6, "evidence", "searched"),
    "figure7": Figure(_figure7, "evidence", "mapping"),
    "figure8": Figure(_figure8, "evidence", "mapping"),
    "figure9": Figure(_figure9, "trainings", "ladders"),
    "figure10": Figure(_figure10, "evidence", "mapping"),
    "figure11": Figure(_figure11, "evidence", "elsewhere"),
    "figure12": Figure(_figure12, "benchmark", "benchmark"),
    "figure13": Figure(_figure13, "real", "benchmark"),
    "figure14": Figure(_figure14, "evidence", "universes"),
    "figure15": Figure(_figure15, "evidence", "choices"),
    "method": Figure(_nothing, "ideas", "explained.method"),
    "fake_pose": Figure(_nothing, "ideas", "explained.fake_pose"),
    "increments": Figure(_nothing, "ideas", "explained.increments"),
    "schedule": Figure(_nothing, "ideas", "explained.schedule"),
    "multiverse": Figure(_multiverse, "ideas", "explained.multiverse"),
}


def draw(figure: str, evidence: Evidence) -> "matplotlib.figure.Figure":
    """A figure from what it declares; `style.STYLE` is for the caller to set."""
    return getattr(import_module(FIGURES[figure].home), figure)(evidence)


def publish(figure: str, evidence: Evidence, svg: Path, png: Path) -> None:
    """Draw a figure into files."""
    from recalib.study.plots.style import STYLE, plt, save

    with plt.rc_context(STYLE):
        save(draw(figure, evidence), svg, png)


def drawn(study: Study, request: Callable[[], Request]) -> list[str]:
    """The figures of a default run of this study: those for which it has what they need."""
    return possible(["trainings", "evidence"][: 1 + study.experiments.evidence], request)


def possible(parts: Collection[str], request: Callable[[], Request]) -> list[str]:
    """The figures of these parts of a study for which it has what they need."""
    found = []
    for name, figure in FIGURES.items():
        ask = request()
        figure.needs(ask)
        if figure.part in parts and not ask.lacking:
            found.append(name)
    return found
