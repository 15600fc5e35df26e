"""Every figure: what it reads, and when it is drawn. Nothing here draws."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import product
from typing import Literal

from recalib.study.configuration.study import Study
from recalib.study.configuration.switches import IMPROVED, RITTER, SWITCHES
from recalib.study.evidence.claims.speed_up import READINGS
from recalib.study.evidence.claims.switches import ask_for
from recalib.study.evidence.needs import Needs, Request
from recalib.study.layout import SHIPPED


@dataclass(frozen=True)
class Figure:
    """A figure.

    Attributes:
        needs: asks for what it reads.
        part: of a study that draws it: its trainings where they suffice, its evidence, or a target
            of its own. An idea is explained once, with the shipped study.
    """

    needs: Callable[[Request], None]
    part: Literal["trainings", "evidence", "benchmark", "real", "ideas"]


def _figure1(ask: Request) -> None:
    ask.history(ask.fact("improved"))
    ask.scenario()
    ask.fact("tests")


def _figure2(ask: Request) -> None:
    for learner in ask.fact("learners"):
        ask.history(learner)
    ask.fact("compared")


def _figure3(ask: Request) -> None:
    for scenario, learner in product(ask.fact("scenarios"), ask.fact("learners")):
        ask.history(learner, scenario)


def _figure4(ask: Request) -> None:
    own = ask.fact("switches"), ask.fact("beside")
    if not any(own):
        ask.lack("experiments.switches: true")
    ask_for(ask, SWITCHES if own[0] else ())
    for learner in own[1] or ():
        ask.history(learner)
    ask.fact("iterations")


def _figure5(ask: Request) -> None:
    ask.mapping("coupling")
    ask.fact("scenarios")


def _figure6(ask: Request) -> None:
    for role in ("improved", "ritter"):
        ask.sample(ask.fact(role))
    ask.fact("iterations")


def _figure7(ask: Request) -> None:
    ask.mapping("propagation")
    for fact in ("balls", "radius"):
        ask.fact(fact)


def _figure8(ask: Request) -> None:
    ask.mapping("visits")


def _figure9(ask: Request) -> None:
    for learner in (IMPROVED, *READINGS):
        ask.ladder(learner)
    ask.history(ask.fact("improved"))
    ask.fact("seed")
    own = ask.fact("iterations")
    if own not in ask.study.experiments.ladder.get(IMPROVED, ()):
        ask.lack(f"experiments.ladder.{IMPROVED}: {own}")


def _figure10(ask: Request) -> None:
    ask.assignments()
    for fact in ("published", "assignment_poses"):
        ask.fact(fact)


def _figure11(ask: Request) -> None:
    ask.ensemble(IMPROVED, "assignments")
    ask.ensemble(IMPROVED, "scaled")
    ask.ensemble(RITTER, "assignments")
    for scenario, learner in product(ask.fact("elsewhere").values(), ask.fact("learners")):
        ask.history(learner, scenario)


def _figure12(ask: Request) -> None:
    ask.benchmark()


def _figure13(ask: Request) -> None:
    ask.real()
    for fact in ("real_robot", "published_mm"):
        ask.fact(fact)


def _universes(ask: Request) -> None:
    if not ask.outcomes():
        ask.lack(f"name: {SHIPPED}")
    ask.fact("seed")


def _nothing(ask: Request) -> None:
    """Of a picture that shows no result."""


FIGURES: Mapping[str, Figure] = {
    "figure1": Figure(_figure1, "trainings"),
    "figure2": Figure(_figure2, "trainings"),
    "figure3": Figure(_figure3, "trainings"),
    "figure4": Figure(_figure4, "trainings"),
    "figure5": Figure(_figure5, "evidence"),
    "figure6": Figure(_figure6, "evidence"),
    "figure7": Figure(_figure7, "evidence"),
    "figure8": Figure(_figure8, "evidence"),
    "figure9": Figure(_figure9, "trainings"),
    "figure10": Figure(_figure10, "evidence"),
    "figure11": Figure(_figure11, "evidence"),
    "figure12": Figure(_figure12, "benchmark"),
    "figure13": Figure(_figure13, "real"),
    "figure14": Figure(_universes, "evidence"),
    "figure15": Figure(_universes, "evidence"),
    "method": Figure(_nothing, "ideas"),
    "fake_pose": Figure(_nothing, "ideas"),
    "increments": Figure(_nothing, "ideas"),
    "schedule": Figure(_nothing, "ideas"),
    "multiverse": Figure(_universes, "ideas"),
}


IDEAS = [name for name, figure in FIGURES.items() if figure.part == "ideas"]


def needs_of(figure: str, request: Callable[[], Request]) -> Needs:
    """What a figure reads."""
    ask = request()
    FIGURES[figure].needs(ask)
    return ask.needs


def drawn(study: Study, request: Callable[[], Request]) -> list[str]:
    """The figures of a default run of this study: those for which it has what they need."""
    parts = {"trainings", "evidence"} if study.experiments.evidence else {"trainings"}
    found = []
    for name, figure in FIGURES.items():
        ask = request()
        figure.needs(ask)
        if figure.part in parts and not ask.lacking:
            found.append(name)
    return found
