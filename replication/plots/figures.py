"""Which figures there are; `drawing` draws them. Words: workflow/templates/figures.yaml."""

from enum import Enum
from pathlib import Path

from replication.config.shipped import OUTCOMES, SHIPPED
from replication.config.study import Study


class Figure(Enum):
    """A figure, by the module and the function that draw it; numbered in this order."""

    FIGURE_1 = "learning:figure_1"
    STEPS = "steps:steps"
    CONTRASTS = "contrasts:contrasts"
    LEARNERS = "learning:learners"
    SCENARIOS = "learning:scenarios"
    AMOUNTS = "learning:amounts"
    MAPPING = "mapping:mapping"
    BENCHMARK = "benchmark:benchmark"
    REAL_ARM = "benchmark:real_arm"

    @property
    def number(self) -> int:
        """By which pages call it."""
        return [*Figure].index(self) + 1

    @property
    def file(self) -> str:
        """The name of its files, without a suffix."""
        return f"figure{self.number}"


APART = Figure.BENCHMARK, Figure.REAL_ARM  # of targets of their own


def figures_of(study: Study) -> list[str]:
    """The files, without suffix, of the figures for which a default run of a study has results."""
    lacking = {*APART}
    if not study.experiments.evidence:
        lacking |= {Figure.MAPPING, Figure.AMOUNTS}
    judged = study.experiments.evidence and study.name == SHIPPED and Path(OUTCOMES).exists()
    if not judged:
        lacking |= {Figure.STEPS, Figure.CONTRASTS}
    return [figure.file for figure in Figure if figure not in lacking]
