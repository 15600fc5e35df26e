"""Formats of numbers on pages."""

import math
from collections.abc import Callable

from tabulate import tabulate

from replication.judgement.findings import Number

ROUNDING = 1e-6  # smaller numbers differ between machines


def short(value: float) -> str:
    """A number with three significant digits."""
    if 0 < abs(value) < ROUNDING:
        return "below 1e-6"
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.3g}"


def percent(value: float) -> str:
    """A share in percent, with two significant digits."""
    return f"{short(float(f'{100 * value:.2g}'))} %"


def interval(ends: tuple[float, float], form: Callable[[float], str] = short) -> str:
    """An interval, as in "0.11 to 0.14"; a common unit appears once."""
    low, high = map(form, ends)
    unit = " %" if low.endswith(" %") and high.endswith(" %") else ""
    return f"{low.removesuffix(unit)} to {high}"


def estimate(number: Number, form: Callable[[float], str] = short) -> str:
    """The value with its interval, as in "0.12 (0.11 to 0.14)"."""
    text = " ".join(filter(None, [number.bound, form(number.value)]))
    if number.interval is None or form(number.interval[0]) == form(number.interval[1]):
        return text
    return f"{text} ({interval(number.interval, form)})"


def ratio(deviation: float) -> str:
    """A standard deviation of logarithms as a relative deviation in percent."""
    return percent(math.expm1(deviation))


def aligned(rows: list[dict[str, str]]) -> str:
    """A table for a terminal; the keys are the headings."""
    return tabulate(rows, headers="keys", disable_numparse=True)
