"""What colours and signs mean in every figure: also in black and white, and to the colour-blind."""

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import cycle
from typing import Any

from replication.config.switches import IMPROVED, RITTER
from replication.training.competitors import label_of, peers
from replication.training.measured import ERRORS, KINDS, UNITS

SOLID, DASHED, DOTTED = "-", (0, (5, 2)), (0, (1, 1))


@dataclass(frozen=True)
class Style:
    """How a learner or an error is shown.

    Attributes:
        color: unlike that of all else in a figure, to the colour-blind, too; a test measures it.
        marker: empty for none.
    """

    color: str
    marker: str
    linestyle: Any
    label: str

    def line(self) -> dict[str, Any]:
        """How Matplotlib is told to draw a curve."""
        return {"color": self.color, "linestyle": self.linestyle}

    def signs(self) -> dict[str, Any]:
        """How Matplotlib is told to draw points."""
        return {"color": self.color, "marker": self.marker or "."}


@dataclass(frozen=True)
class ErrorStyle(Style):
    """How one of the two errors is shown; its label is that of an axis."""

    column: str
    kind: str
    unit: str


LABELS = "position error [cm]", "orientation error [degrees]"
COLOURS, LINES = ("#2722A9", "#923701"), (SOLID, DASHED)
BOTH = tuple(map(ErrorStyle, COLOURS, "os", LINES, LABELS, ERRORS, KINDS, UNITS))
HOLDS, FAILS = "#44AA99", "#580644"
NEUTRAL = "black"
INK = "0.25"  # of pictures of ideas
BORDER: dict[str, Any] = {
    "color": "0.4",
    "linewidth": 0.8,
}  # a line that parts one side from the other
# After Okabe and Ito's palette, whose pink, green, orange and grey some take for each other; in the
# order of the learners. Later ones look as those nobody foresaw.
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
# For the learner trained for another number of iterations, and for those that nobody foresaw.
# Paler for its kin.
OTHER = {IMPROVED: ("#80B9D9", "d"), RITTER: ("#D3977E", "^")}
# The first is Ritter's net with the cells of both maps; to the colour-blind, too, it is unlike his.
UNKNOWN = ("#661100", "X"), ("#ECDB79", "h"), ("0.4", "<"), ("#999933", ">"), ("#AA4499", "p")


def styles_of(learners: Iterable[str]) -> dict[str, Style]:
    """How the learners of one figure are shown, by name."""
    found: dict[str, Style] = {}
    unknown = cycle(UNKNOWN)
    for learner in learners:
        name = re.sub(r"_\d+$", "", learner)
        if learner in STYLES:
            found[learner] = STYLES[learner]
        elif name in OTHER:
            color, marker = OTHER[name]
            found[learner] = replace(STYLES[name], color=color, marker=marker, linestyle=DOTTED)
        else:
            color, marker = next(unknown)
            found[learner] = Style(color, marker, DASHED, label_of(learner))
    return found
