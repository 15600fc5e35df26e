"""The list of figures. `rendering` draws them; captions are in workflow/templates/figures.yaml."""

from enum import Enum
from pathlib import Path

from replication.config.shipped import OUTCOMES, SHIPPED
from replication.config.study import Study


class Figure(Enum):
    """A figure, with the module and the function that draw it. The order gives the numbers."""

    FIGURE_1 = "learning:figure_1"
    STEPS = "factor:steps"
    CONTRASTS = "forest:contrasts"
    LEARNERS = "learning:learners"
    SCENARIOS = "learning:scenarios"
    AMOUNTS = "learning:amounts"
    MAPPING = "mapping:mapping"
    BENCHMARK = "comparison:benchmark"
    REAL_ARM = "comparison:real_arm"

    @property
    def number(self) -> int:
        """The figure's number on pages."""
        return [*Figure].index(self) + 1

    @property
    def file(self) -> str:
        """The name of its files without suffix."""
        return f"figure{self.number}"


APART = Figure.BENCHMARK, Figure.REAL_ARM  # not made by the default target


def figures_of(study: Study) -> list[str]:
    """The figures for which a default run of a study has results, as file names without suffix."""
    missing = {*APART}
    if not study.experiments.evidence:
        missing |= {Figure.MAPPING, Figure.AMOUNTS}
    judged = study.experiments.evidence and study.name == SHIPPED and Path(OUTCOMES).exists()
    if not judged:
        missing |= {Figure.STEPS, Figure.CONTRASTS}
    return [figure.file for figure in Figure if figure not in missing]
