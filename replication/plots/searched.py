"""The figure of the search for widths and rates."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from replication.config.switches import IMPROVED, RITTER
from replication.judgement.claims import rough_search
from replication.judgement.results import Evidence
from replication.plots.palette import BOTH, NEUTRAL, ErrorStyle, styles_of
from replication.plots.style import BAND, band, legend_under, line_across, logarithmic, title

REMAINS = {  # what the search minimises
    "worse": "larger remaining share of both errors",
    "geometric_mean": "remaining share, geometric mean",
}
# narrow and wide, as the paper wants
NETS = {"position": ("g_k", "g_kl"), "orientation": ("g_kl", "g_k")}
SIZE = 9.5  # points: a label no wider than its panel
ABOVE = 18  # points, in which stands what an upright line is
PARTS = 10  # of the trials, from one end of the ratios to the other


def _first_rounds(evidence: Evidence, learner: str) -> pd.DataFrame:
    """Trials that depend on no other."""
    return evidence.sample(learner).query("round == 1")


def _best(trials: pd.DataFrame) -> np.ndarray:
    """The least score (search, n) among the first n trials."""
    scores = [its["score"].to_numpy() for _, its in trials.groupby("search")]
    return np.minimum.accumulate(np.stack(scores), axis=1)


def _draw_shares(axes: Axes, evidence: Evidence) -> float:
    """The error that remains with the best of few trials; returns the improved system's median."""
    rough, median = evidence.facts["rough_trials"], {}
    trained = {IMPROVED: evidence.facts["improved"], RITTER: evidence.facts["ritter"]}
    for role, style in styles_of(trained).items():
        best = _best(_first_rounds(evidence, trained[role]))
        trials = np.arange(1, best.shape[1] + 1)
        low, median[role], high = np.percentile(best, (BAND[0], 50, BAND[1]), axis=0)
        band(axes, trials, (low, high), style.color)
        length = evidence.sought(trained[role]).learner.iterations
        name = f"{style.label}, {length:,} iterations"
        axes.plot(trials, median[role], label=name, **style.line())
    limit = rough_search.CLAIM.limits["left"]
    line_across(axes, f"a {limit:word}", y=limit)
    line_across(axes, f"{rough} trials", x=rough)
    axes.set_xlabel("random trials, of which the best counts", fontsize=SIZE)
    axes.set_ylabel(REMAINS[evidence.sought(trained[IMPROVED]).budget.score])
    axes.yaxis.label.set_fontsize(SIZE)
    logarithmic(axes.xaxis, 1, 2, 4, 8, 16, 32, 64)
    logarithmic(axes.yaxis, 0.05, 0.1, 0.2, 0.5, 1)
    axes.set_title("How rough may the search be?", pad=ABOVE)
    legend_under(axes)
    return median[IMPROVED][rough - 1]


def _draw_order(axes: Axes, trials: pd.DataFrame, error: ErrorStyle) -> None:
    """One map's error against the order of its widths, and the mean rank correlation."""
    narrow, wide = NETS[error.kind]
    table = trials[["search"]].assign(
        ratio=trials[f"{error.kind}/{narrow}"] / trials[f"{error.kind}/{wide}"],
        error=trials[error.column],
    )
    ranks = [its[["ratio", "error"]].rank() for _, its in table.groupby("search")]
    found = float(np.mean([its.corr().iloc[0, 1] for its in ranks]))
    axes.scatter(table["ratio"], table["error"], s=5, alpha=0.4, color=error.color, linewidths=0)
    ordered = table.sort_values("ratio")[["ratio", "error"]].to_numpy()
    middles = np.array([np.median(part, axis=0) for part in np.array_split(ordered, PARTS)])
    axes.plot(*middles.T, color=NEUTRAL, linewidth=2, label="median of a tenth of the trials")
    line_across(axes, "equally wide", x=1)
    axes.set_xlabel(f"final width of {narrow} over {wide}", fontsize=SIZE)
    axes.set_ylabel(error.label, fontsize=SIZE)
    logarithmic(axes.xaxis, 0.1, 0.3, 1, 3, 10)
    logarithmic(axes.yaxis, 0.2, 0.5, 1, 2, 5, 10)
    axes.set_title(f"{error.kind.capitalize()} map: rank\ncorrelation {found:+.2f}", pad=ABOVE)
    legend_under(axes)


def figure6(evidence: Evidence) -> Figure:
    """What the searches found: how good after how many trials, and which order of widths."""
    figure, panels = plt.subplots(1, 3, figsize=(10, 4.8))
    remaining = _draw_shares(panels[0], evidence)
    improved = evidence.facts["improved"]
    trials, budget = _first_rounds(evidence, improved), evidence.sought(improved)
    for axes, error in zip(panels[1:], BOTH, strict=True):
        _draw_order(axes, trials, error)
    title(
        figure,
        f"Figure 6: with the best of {evidence.facts['rough_trials']} random trials,"
        f" {100 * remaining:.0f} % of the error remains in the search",
        f"first rounds of {budget.searches} searches at {evidence.facts['iterations']} iterations,"
        f" {budget.budget.seeds} seeds a trial; the claims are judged by other searches and poses."
        f"\nLeft: medians and {BAND[0]}-{BAND[1]} % of the searches. Middle and right: improved"
        " system; above 0, the paper's order of widths is the better one",
    )
    return figure
