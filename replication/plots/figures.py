"""Which figures there are, with their captions; `drawing` draws them."""

from enum import Enum

from replication.config.shipped import SHIPPED
from replication.config.study import Study
from replication.judgement.claims.claim import FEWEST
from replication.judgement.evidence import Evidence, NotMeasured


class Figure(Enum):
    """A figure, by the module and the function that draw it; numbered in this order."""

    FIGURE_1 = "learning.figure_1"  # the paper's only one
    STEPS = "steps.steps"
    CONTRASTS = "contrasts.contrasts"
    LEARNERS = "learning.learners"
    SCENARIOS = "learning.scenarios"
    AMOUNTS = "damages.amounts"
    MAPPING = "mapping.mapping"
    BENCHMARK = "benchmark.benchmark"
    REAL_ARM = "benchmark.real_arm"

    @property
    def number(self) -> int:
        """By which pages call it."""
        return [*Figure].index(self) + 1

    @property
    def title(self) -> str:
        """What it shows, in a line: for those who do not see it, too."""
        return TITLES[self]

    def caption(self, study: Study) -> str:
        """What its signs mean."""
        return CAPTIONS[self].format(study=study)

    @property
    def file(self) -> str:
        """The name of its files, without a suffix."""
        return f"figure{self.number}"


APART = Figure.BENCHMARK, Figure.REAL_ARM  # of targets of their own

TITLES = {
    Figure.FIGURE_1: "Both errors fall while the learner learns.",
    Figure.STEPS: "Where the factor comes from: iterations that each step needs.",
    Figure.CONTRASTS: "What each claim says, in every setup.",
    Figure.LEARNERS: "The learners on the paper's damage.",
    Figure.SCENARIOS: "Both errors before and after learning, for each damage and robot.",
    Figure.AMOUNTS: "Slighter and greater damages.",
    Figure.MAPPING: "The damage and the mapping, before any learning.",
    Figure.BENCHMARK: "Learners of 1996 and of today, against robot moves.",
    Figure.REAL_ARM: "Learners on a real arm.",
}
CAPTIONS = {
    Figure.FIGURE_1: (
        "Mean errors over {study.training.tests} test poses, from which nothing is learned, against"
        " iterations of two moves each. Lines: means over {study.training.seeds} seeds; bands: 5 to"
        " 95 % of the seeds. Right: the same errors on a logarithmic scale."
    ),
    Figure.STEPS: (
        "The reference study. Top: the larger of both errors, as a share of the arm's error without"
        " correction, against the number of iterations for which a system is tuned. The level line"
        " is the improved system's error after {study.experiments.iterations} iterations. Bottom:"
        " iterations after which each system reaches this error, and their ratio to"
        " {study.experiments.iterations}. The increments are those of two maps. In all systems but"
        " the improved one, widths and rate fall as Ritter's. Ritter's map has as many cells as"
        " both new maps together, or half as many. Last row: the same number in all setups (dots; a"
        " triangle is a lower bound), their mean (diamond) with its 95 % interval (thick line), and"
        " the interval for one more study (thin line). Dashed: the paper's factor of 70."
    ),
    Figure.CONTRASTS: (
        "Top: the error of the first variant over the error of the second. Bottom: the larger"
        " remaining share of both errors. Dots: setups; diamond: their mean, with its 95 % interval"
        " (thick line) and the interval for one more study (thin line). On the shaded side the"
        " paper is right; between the dotted lines, errors differ by less than 10 %. Seven rows"
        " concern Ritter's framework (section 4), the next five the improved system. Supernet /"
        " subnets: fewer cells in the one / in the other. Drastic change: the advantage of"
        " increments there / in the paper's damage. Numbers: the mean of the setups."
    ),
    Figure.LEARNERS: (
        "Mean errors over {study.training.tests} test poses against iterations of two moves each,"
        " with means (lines) and 5 to 95 % (bands) of {study.training.seeds} seeds. Each training"
        " has settings that are tuned for its last iteration. Level line: the error at which the"
        " training of Figure 1 ends."
    ),
    Figure.SCENARIOS: (
        "Means over {study.training.seeds} seeds; lines: 5 to 95 % of them. Errors below 0.001 are"
        " drawn there. Other robots have the settings of the study's own."
    ),
    Figure.AMOUNTS: (
        "Errors of the improved system before and after {study.experiments.iterations} iterations,"
        " against the size of the damage, where 1 is the paper's. Lines: medians over random"
        " assignments of the damage to links and encoders; bands: 5 to 95 % of them. The settings"
        " are tuned for the paper's damage."
    ),
    Figure.MAPPING: (
        "Initial errors (section 7): every assignment of the paper's damage to links, encoders and"
        " signs; cross: the published errors; circle: the assignment that is used. Coupling (4):"
        " norm of the off-diagonal blocks of the mapping's Jacobian over that of the diagonal ones,"
        " for position and orientation commands, at 95 % of the poses of each setup; line: the"
        " criterion. What to propagate (5): below 1, the old mapping plus a constant is nearer to"
        " the new mapping than a constant is; medians over {study.mapping.balls} balls, for"
        " commands of the intact arm and Jacobians of the damaged one. Expected learning (6):"
        " simulation over equation (10), against the distance of a cell from the border of the"
        " workspace; line: the criterion."
    ),
    Figure.BENCHMARK: (
        "Means over {study.benchmark.seeds} seeds; bands: 95 % intervals. An iteration of the"
        " paper's learners takes two moves. Errors below 1 micrometre are drawn there. Where the"
        " geometric learner is as good as the hybrid one, its line lies below."
    ),
    Figure.REAL_ARM: (
        "Mean position error on test poses, measured by laser tracker, against the number of poses"
        " that were learned from. Means over {study.real.subsets} random subsets; bands: 95 %"
        " intervals. The paper's learners choose their poses themselves, so they learn on a twin"
        " of the arm, identified from all poses. Level line: the error published with the data."
    ),
}


def figures_of(study: Study) -> list[str]:
    """The files, without suffix, of the figures for which a default run of a study has results."""
    evidence, setups = study.experiments.evidence, _setups(study)
    lacking = {
        Figure.STEPS: not setups,
        Figure.CONTRASTS: len(setups) < FEWEST,
        Figure.MAPPING: not evidence,
        Figure.AMOUNTS: not evidence,
    }
    return [its.file for its in Figure if its not in APART and not lacking.get(its)]


def _setups(study: Study) -> set[int]:
    """The setups of the campaign that are measured so far, if the study judges by them."""
    if study.name != SHIPPED or not study.experiments.evidence:
        return set()
    try:
        return set(Evidence(study).outcomes()["setup"])
    except NotMeasured:
        return set()
