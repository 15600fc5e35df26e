"""Draws the figures of a study into files."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import matplotlib.figure
import matplotlib.pyplot as plt

from replication.config.study import Study
from replication.judgement.evidence import Evidence
from replication.plots.benchmark import benchmark, real_arm
from replication.plots.contrasts import contrasts
from replication.plots.damages import amounts
from replication.plots.figures import Figure
from replication.plots.learning import figure_1, learners, scenarios
from replication.plots.mapping import mapping
from replication.plots.steps import steps
from replication.plots.style import STYLE, save

FUNCTIONS: Mapping[str, Callable[[Evidence], matplotlib.figure.Figure]] = {
    function.__name__: function
    for function in (
        figure_1,
        steps,
        contrasts,
        learners,
        scenarios,
        amounts,
        mapping,
        benchmark,
        real_arm,
    )
}


def draw(study: Study, figures: Sequence[Path]) -> None:
    """Draw figures into files, each of which has the name of one. Raises NotMeasured."""
    evidence, known = Evidence(study, Path.cwd()), {its.file: its for its in Figure}
    with plt.rc_context(STYLE):
        for name in dict.fromkeys(path.stem for path in figures):
            paths = [path for path in figures if path.stem == name]
            save(FUNCTIONS[known[name].value](evidence), *paths)
