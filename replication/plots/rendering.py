"""Draw the figures of a study into files."""

from collections.abc import Sequence
from pathlib import Path
from pkgutil import resolve_name

import matplotlib.figure
import matplotlib.pyplot as plt

from replication.config.study import Study
from replication.judgement.evidence import Evidence
from replication.plots.figures import Figure
from replication.plots.style import STYLE, save


def drawn(figure: Figure, evidence: Evidence) -> matplotlib.figure.Figure:
    """A figure of a study's results. Raises NotMeasured."""
    return resolve_name(f"replication.plots.{figure.value}")(evidence)


def draw(study: Study, figures: Sequence[Path]) -> None:
    """Draw figures into files that have the figures' names. Raises NotMeasured."""
    evidence, by_name = Evidence(study), {figure.file: figure for figure in Figure}
    with plt.rc_context(STYLE):
        for name in dict.fromkeys(path.stem for path in figures):
            paths = [path for path in figures if path.stem == name]
            save(drawn(by_name[name], evidence), *paths)
