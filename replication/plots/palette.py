"""Colours and markers of all figures, distinct in black and white and to the colour-blind."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import cycle
from typing import Any

from replication.config.switches import IMPROVED, RITTER
from replication.training.competitors import label_of, peers
from replication.training.measured import ERRORS, KINDS, UNITS

SOLID, DASHED, DOTTED = "-", (0, (5, 2)), (0, (1, 1))


@dataclass(frozen=True)
class Style:
    """The style of a learner or an error."""

    color: str  # distinct from others in a figure, also to the colour-blind; a test checks this
    marker: str  # empty for none
    linestyle: Any
    label: str

    def line(self) -> dict[str, Any]:
        """Matplotlib's arguments for a curve."""
        return {"color": self.color, "linestyle": self.linestyle}

    def signs(self) -> dict[str, Any]:
        """Matplotlib's arguments for points."""
        return {"color": self.color, "marker": self.marker or "."}


@dataclass(frozen=True)
class ErrorStyle(Style):
    """The style of one of the two errors; its label is for an axis."""

    column: str
    kind: str
    unit: str


LABELS = "position error [cm]", "orientation error [degrees]"
COLOURS, LINES = ("#2722A9", "#923701"), (SOLID, DASHED)
BOTH = tuple(map(ErrorStyle, COLOURS, "os", LINES, LABELS, ERRORS, KINDS, UNITS))
HOLDS, FAILS = "#44AA99", "#580644"
NEUTRAL = "black"
INK = "0.25"  # for sketches of ideas
GREY = "0.4"  # for text and lines next to the data
BORDER: dict[str, Any] = {"color": GREY, "linewidth": 0.8}  # for limits
# Okabe and Ito's palette, modified because some people confuse its pink, green, orange and grey; in
# the order of the learners. Further learners get styles from `UNKNOWN`.
SIGNS = (
    ("#0072B2", "o"),
    ("#D55E00", "P"),
    ("#757575", ""),
    ("#CD87AD", "v"),
    ("#FFCF62", "^"),
    ("#05AB6E", "D"),
    ("#61D6FF", "s"),
    ("#000000", "*"),
)
STYLES = {
    name: Style(*signs, DASHED if name == RITTER else SOLID, label_of(name))
    for name, signs in zip((IMPROVED, RITTER, *peers()), SIGNS, strict=False)
}
SHORTER = {IMPROVED: ("#80B9D9", "d"), RITTER: ("#D3977E", "^")}  # for shorter trainings
UNKNOWN = ("#661100", "X"), ("#ECDB79", "h"), (GREY, "<"), ("#999933", ">"), ("#AA4499", "p")

Training = tuple[str, int]  # a learner, and its number of iterations


def styles_of(learners: Iterable[str]) -> dict[str, Style]:
    """The styles of the learners in one figure, by name."""
    unknown = cycle(UNKNOWN)
    return {
        name: STYLES.get(name) or Style(*next(unknown), DASHED, label_of(name))
        for name in dict.fromkeys(learners)
    }


def styles_of_trainings(lengths: Mapping[str, Iterable[int]]) -> dict[Training, Style]:
    """The styles of trainings: a learner's style for its longest one, paler for shorter ones."""
    ordered = sorted((name, length) for name in lengths for length in lengths[name])
    longest, unknown = dict(ordered), cycle(reversed(UNKNOWN))
    by_learner, styles = styles_of(longest), {}
    for name, length in ordered:
        style = replace(by_learner[name], label=f"{by_learner[name].label}, {length:,} iterations")
        if length < longest[name]:
            color, marker = SHORTER.get(name) or next(unknown)
            style = replace(style, color=color, marker=marker, linestyle=DOTTED)
        styles[name, length] = style
    return styles
