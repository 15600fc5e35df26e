"""The figure of slighter and greater damages."""

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from replication.judgement.evidence import Evidence
from replication.plots.palette import BOTH, GREY
from replication.plots.style import BAND, WIDTH, band, logarithmic, note


def amounts(evidence: Evidence) -> Figure:
    """Both errors of the improved system before and after learning, by the size of the damage."""
    by_size = evidence.table("ensemble.parquet").groupby("scale")
    figure, panels = plt.subplots(1, 2, figsize=(WIDTH, 2.6))
    for axes, error in zip(panels, BOTH, strict=True):
        for moment, color, marker in (("initial", GREY, "^"), ("final", error.color, error.marker)):
            its = by_size[f"{moment}_{error.column}"]
            low, middle, high = (
                its.quantile(share) for share in (BAND[0] / 100, 0.5, BAND[1] / 100)
            )
            band(axes, middle.index, (low, high), color)
            axes.plot(middle.index, middle, color=color, marker=marker)
        axes.set(xlabel="size of the damage (paper: 1)", ylabel=error.label)
        for text, at, side, color in (
            ("before", (0.04, 0.95), "left", GREY),
            ("after", (0.98, 0.05), "right", error.color),
        ):
            note(axes, text, at, (0, 0), xycoords="axes fraction", ha=side, color=color)
        logarithmic(axes.xaxis, 0.1, 0.3, 1, 3)
        logarithmic(axes.yaxis, 0.01, 0.1, 1, 10)
    return figure
