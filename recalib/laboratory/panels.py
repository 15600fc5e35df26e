"""Drawings in SVG: panels side by side, each with two axes and what lies between them."""

from collections.abc import Iterator, Sequence
from html import escape

import numpy as np
from numpy.typing import ArrayLike

LEFT, RIGHT, TOP, BOTTOM = 56, 12, 24, 44  # about the field of a panel, for numbers and labels
MARGIN = 0.04  # of an axis beyond its numbers
TICKS = 5  # about so many on an axis
ROUND = np.array([1, 2, 5, 10])  # of which tick is which power of ten's multiple
BROAD = 3.0  # so wide is a spike where it begins


class Axis:
    """Numbers along a side of a panel.

    Args:
        label: what they are.
        numbers: all that are to be seen.
        least: of a logarithmic axis, where smaller numbers are drawn; it is linear unless given.

    Attributes:
        ends: the first and the last place on it.
    """

    def __init__(self, label: str, numbers: ArrayLike, least: float | None = None):
        self.label, self._least = label, least
        values = np.asarray(numbers, dtype=float)
        low, high = self.places(np.array([values.min(), values.max()]))
        margin = MARGIN * (high - low) or 0.5
        self.ends = low - margin, high + margin

    def places(self, numbers: np.ndarray) -> np.ndarray:
        """Where numbers are on it."""
        return numbers if self._least is None else np.log10(np.maximum(numbers, self._least))

    def ticks(self) -> np.ndarray:
        """Round numbers on it."""
        low, high = self.ends
        if self._least is None:
            power = 10 ** np.floor(np.log10((high - low) / TICKS))
            step = power * ROUND[np.searchsorted(ROUND, (high - low) / TICKS / power)]
            return step * np.arange(np.ceil(low / step), np.floor(high / step) + 1) + 0.0  # no -0
        powers = 10.0 ** np.arange(np.floor(low), np.ceil(high))
        numbers = np.outer(powers, ROUND[:3] if len(powers) < TICKS - 1 else 1).ravel()
        return numbers[(np.log10(numbers) >= low) & (np.log10(numbers) <= high)]


class Panel:
    """A field between two axes. What is drawn last lies on top.

    Args:
        size: width and height, with what stands about the field.
        axes: across and up.
        title: what stands above it.
        alike: whether both axes are drawn at one scale.
    """

    def __init__(
        self, size: tuple[float, float], axes: Sequence[Axis], title: str = "", alike: bool = False
    ):
        self.size, self._axes = size, axes
        field = np.subtract(size, (LEFT + RIGHT, TOP + BOTTOM))
        low, high = np.transpose([axis.ends for axis in axes])
        scale = field / (high - low)
        if alike:
            scale[:] = scale.min()
        self._scale = scale * [1, -1]
        self._origin = [LEFT, TOP] + field / 2 - self._scale * (low + high) / 2
        self.drawn = [f'<text x="{LEFT}" y="{TOP - 8}">{escape(title)}</text>', *self._frame(field)]

    def line(self, across: np.ndarray, up: np.ndarray, colour: str, wide: float) -> None:
        """A line through points (n,)."""
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in self._on_page(across, up))
        self.drawn.append(
            f'<polyline points="{points}" stroke="{colour}" stroke-width="{wide}" fill="none"/>'
        )

    def dots(self, across: np.ndarray, up: np.ndarray, colour: str, wide: float) -> None:
        """Points (n,); of those that nobody can tell apart, one."""
        places = np.unique(self._on_page(across, up).round(), axis=0)
        d = "".join(f"M{x:.0f} {y:.0f}h0" for x, y in places)
        self.drawn.append(
            f'<path d="{d}" stroke="{colour}" stroke-width="{wide}" stroke-linecap="round"/>'
        )

    def spikes(self, start: np.ndarray, end: np.ndarray, colour: str) -> None:
        """From points to others (n, 2), broad where they begin and sharp where they end."""
        start, end = self._on_page(*start.T), self._on_page(*end.T)
        along = (end - start) / np.maximum(np.linalg.norm(end - start, axis=1, keepdims=True), 1e-9)
        beside = BROAD / 2 * along[:, ::-1] * [-1, 1]
        corners = np.concatenate([start + beside, end, start - beside], axis=1)
        d = "".join("M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}z".format(*six) for six in corners)
        self.drawn.append(f'<path d="{d}" fill="{colour}"/>')

    def _on_page(self, across: np.ndarray, up: np.ndarray) -> np.ndarray:
        """Where points (n,) are on the panel (n, 2), from its upper left corner."""
        return np.stack([self._along(0, across), self._along(1, up)], axis=-1)

    def _along(self, side: int, numbers: np.ndarray) -> np.ndarray:
        return self._origin[side] + self._scale[side] * self._axes[side].places(numbers)

    def _frame(self, field: np.ndarray) -> Iterator[str]:
        """Grid, numbers and labels."""
        right, bottom = np.add((LEFT, TOP), field)
        (across, up), ticks = self._axes, [axis.ticks() for axis in self._axes]
        for x, number in zip(self._along(0, ticks[0]), ticks[0], strict=True):
            yield f'<path class="grid" d="M{x:.1f} {TOP}V{bottom}"/>'
            yield f'<text x="{x:.1f}" y="{bottom + 16}" class="middle">{number:g}</text>'
        for y, number in zip(self._along(1, ticks[1]), ticks[1], strict=True):
            yield f'<path class="grid" d="M{LEFT} {y:.1f}H{right}"/>'
            yield f'<text x="{LEFT - 6}" y="{y + 4:.1f}" class="end">{number:g}</text>'
        x, y = (LEFT + right) / 2, (TOP + bottom) / 2
        yield f'<text x="{x}" y="{bottom + 36}" class="middle">{escape(across.label)}</text>'
        turned = f'transform="translate(12 {y}) rotate(-90)" class="middle"'
        yield f"<text {turned}>{escape(up.label)}</text>"


def drawing(panels: Sequence[Panel], columns: int) -> str:
    """Panels of one size in rows."""
    width, height = panels[0].size
    placed = [
        f'<g transform="translate({width * (n % columns):g} {height * (n // columns):g})">'
        f"{''.join(panel.drawn)}</g>"
        for n, panel in enumerate(panels)
    ]
    size = f"{width * columns:g} {height * -(-len(panels) // columns):g}"
    return f'<svg viewBox="0 0 {size}">{"".join(placed)}</svg>'
