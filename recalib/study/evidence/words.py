"""Numbers and results in words, for pages."""

from collections.abc import Mapping

from recalib.study.measured import ERRORS, UNITS


def n(value: float, digits: int = 2) -> str:
    """A number for people."""
    if 0 < abs(value) < 10**-digits:
        return _rounding(value) or f"{value:.1e}"
    return f"{value:.{digits}f}"


def _rounding(value: float) -> str:
    """Says of a number that it is what the arithmetic leaves: each machine's differs."""
    return "below 1e-6" if 0 < abs(value) < 1e-6 else ""


def pair(row: Mapping, moment: str) -> str:
    """Both errors of a summary's row at the beginning or the end."""
    errors = (row[f"{moment}_{error}"] for error in ERRORS)
    return ", ".join(f"{n(error)} {unit}" for error, unit in zip(errors, UNITS, strict=True))


def measured(claim: Mapping) -> str:
    """What was measured for a claim, with intervals."""

    def number(value) -> str:
        return "more" if value is None else _rounding(value) or f"{value:.3g}"

    def text(label, value) -> str:
        if label not in claim["interval"]:
            return f"{label}: {number(value)}"
        low, high = claim["interval"][label]
        return f"{label}: {number(value)} ({number(low)} to {number(high)})"

    return "; ".join(text(label, value) for label, value in claim["measured"].items())


def brief(claim: Mapping) -> str:
    """The first number that was measured for a claim, without its interval."""
    label, value = next(iter(claim["measured"].items()))
    number = "more" if value is None else _rounding(value) or f"{value:.3g}"
    return f"{label}: {number}"


def amounts(entry: Mapping) -> str:
    """A damage in the words of the configuration, without their keys."""
    values = (", ".join(each) if isinstance(each, list) else each for each in entry.values())
    return " ".join(map(str, values))
