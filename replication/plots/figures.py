"""Which figures there are, with their captions; `drawing` draws them."""

from enum import Enum
from pathlib import Path

from replication.config.shipped import OUTCOMES, SHIPPED
from replication.config.study import Study


class Figure(Enum):
    """A figure; numbered in this order.

    Attributes:
        function: the module and the function that draw it.
        title: what it shows, in a line: for those who do not see it, too.
    """

    FIGURE_1 = (
        "learning:figure_1",
        "Both errors fall during learning.",
        "Mean errors over {study.training.tests} held-out poses against iterations of two moves"
        " each: means (lines) and 5 to 95 % (bands) of {study.training.seeds} seeds. Right: the"
        " same on a logarithmic scale.",
    )
    STEPS = (
        "steps:steps",
        "Which step saves how many iterations.",
        "The reference study. Top: the larger remaining share of the two errors, against the"
        " number of iterations for which a system is tuned; the horizontal line is the improved"
        " system's share after {study.experiments.iterations} iterations. Bottom: iterations after"
        " which each system reaches this line, and their ratio to {study.experiments.iterations}."
        " Ritter's map has as many cells as both new maps together, or half as many; + means: two"
        " maps with this change. The last row shows the number in every setup (triangle: a lower"
        " bound), and their mean (diamond) with its 95 % interval (thick) and that for one more"
        " study (thin).",
    )
    CONTRASTS = (
        "contrasts:contrasts",
        "The number behind each claim, in every setup.",
        "Top: the error of the first variant divided by the error of the second. Bottom: the larger"
        " remaining share of the two errors. Dots: setups; diamond: their mean, with its 95 %"
        " interval (thick) and that for one more study (thin). The paper is right on the shaded"
        " side; between the dotted lines errors differ by less than 10 %. Seven rows concern"
        " Ritter's framework (section 4), the next five the improved system. Drastic change: the"
        " advantage of increments there, divided by their advantage with the paper's damage.",
    )
    LEARNERS = (
        "learning:learners",
        "The learners on the paper's damage.",
        "Mean errors over {study.training.tests} held-out poses: means (lines) and 5 to 95 %"
        " (bands) of {study.training.seeds} seeds. Each training is tuned for its last iteration."
        " Horizontal line: the final error of Figure 1.",
    )
    SCENARIOS = (
        "learning:scenarios",
        "Both errors before and after learning, for each damage and robot.",
        "Means over {study.training.seeds} seeds; lines: 5 to 95 % of them. Errors below 0.001 are"
        " drawn at 0.001. Other robots are trained with the settings of the study's robot.",
    )
    AMOUNTS = (
        "learning:amounts",
        "Slighter and greater damages.",
        "Errors of the improved system before and after {study.experiments.iterations} iterations,"
        " against the size of the damage (1: the paper's, for which the system is tuned). Lines:"
        " medians over random assignments to links and encoders; bands: 5 to 95 % of them.",
    )
    MAPPING = (
        "mapping:mapping",
        "The damage and the mapping, before any learning.",
        "Initial errors (section 7): every assignment of the paper's damage to links, encoders and"
        " signs; cross: published; circle: used here. Coupling (4): norm of off-diagonal over"
        " diagonal blocks of the mapping's Jacobian at 95 % of the poses of each setup; line: the"
        " criterion. What to propagate (5): below 1, the new mapping is nearer to the old one plus"
        " a constant than to a constant; medians over {study.mapping.balls} regions. Expected"
        " learning (6): simulation over equation (10), against the distance of a cell from the"
        " border of the workspace; line: the criterion.",
    )
    BENCHMARK = (
        "benchmark:benchmark",
        "Learners of 1996 and of today, against robot moves.",
        "Means over {study.benchmark.seeds} seeds; bands: 95 % intervals. An iteration of the"
        " paper's learners takes two moves. Errors below 1 micrometre are drawn at 1 micrometre."
        " The thick line of the geometric learner lies under the line of the hybrid one.",
    )
    REAL_ARM = (
        "benchmark:real_arm",
        "Learners on a real arm.",
        "Mean position error on held-out poses, measured by laser tracker, against the number of"
        " training poses. Means over {study.real.subsets} random subsets; bands: 95 % intervals."
        " The paper's learners choose their poses, so they train on a simulated twin of the arm,"
        " identified from all poses. Horizontal line: the error published with the data.",
    )

    def __init__(self, function: str, title: str, caption: str):
        self.function, self.title, self._caption = function, title, caption

    @property
    def number(self) -> int:
        """By which pages call it."""
        return [*Figure].index(self) + 1

    def caption(self, study: Study) -> str:
        """What its signs mean."""
        return self._caption.format(study=study)

    @property
    def file(self) -> str:
        """The name of its files, without a suffix."""
        return f"figure{self.number}"


APART = Figure.BENCHMARK, Figure.REAL_ARM  # of targets of their own


def figures_of(study: Study) -> list[str]:
    """The files, without suffix, of the figures for which a default run of a study has results."""
    evidence = study.experiments.evidence
    judged = evidence and study.name == SHIPPED and Path(OUTCOMES).exists()
    lacking = {
        Figure.STEPS: not judged,
        Figure.CONTRASTS: not judged,
        Figure.MAPPING: not evidence,
        Figure.AMOUNTS: not evidence,
    }
    return [figure.file for figure in Figure if figure not in APART and not lacking.get(figure)]
