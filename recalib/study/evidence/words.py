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


def one(claim: Mapping, label: str) -> str:
    """One of the numbers measured for a claim, with its interval."""

    def number(value) -> str:
        return "more" if value is None else _rounding(value) or f"{value:.3g}"

    text = number(claim["measured"][label])
    if label in claim["interval"]:
        low, high = map(number, claim["interval"][label])
        text += f" ({low} to {high})"
    return text


def measured(claim: Mapping) -> str:
    """What was measured for a claim, with intervals."""
    return "; ".join(f"{label}: {one(claim, label)}" for label in claim["measured"])


def brief(claim: Mapping) -> str:
    """What was measured first for a claim, with its interval."""
    label = next(iter(claim["measured"]))
    return f"{label}: {one(claim, label)}"


def typical_errors(claim: Mapping) -> str:
    """Where the typical search ends, as the claim about Figure 1 has it."""
    return " and ".join(f"{n(claim['measured'][f'final {unit}'])} {unit}" for unit in UNITS)


def verdicts(claim: Mapping) -> str:
    """The verdict on a claim; of one about several systems, that on each of them as well."""
    text = f"**{claim['verdict']}**"
    by_system = {system: its["verdict"] for system, its in claim["systems"].items()}
    if set(by_system.values()) <= {claim["verdict"]}:
        return text
    return f"{text} ({', '.join(f'{verdict} for {its}' for its, verdict in by_system.items())})"


def in_universes(claim: Mapping) -> str:
    """In how many universes a claim holds."""
    systems = {system: its["universes"] for system, its in claim["systems"].items()}
    found = systems or {"": claim["universes"]}
    counts = (
        f"{share['holds']} of {share['of']}{f' ({system})' if system else ''}"
        for system, share in found.items()
        if share
    )
    return ", ".join(counts) or "cannot vary"


def depends(claim: Mapping) -> str:
    """The choice that moves a claim's number most, and by how much."""
    shares = [its["universes"] for its in claim["systems"].values()] or [claim["universes"]]
    texts = []
    for system, share in zip(claim["systems"] or [""], shares, strict=True):
        its = share["depends_on"]
        if its["times"] == 1:
            text = "none, it is the same in all"
        elif its["times"] <= its["chance"]:
            text = "no choice, by more than chance would show"
        else:
            low, high = its["interval"]
            text = (
                f"{its['factor'].replace('_', ' ')}, {its['times']:.3g} times"
                f" ({low:.3g} to {high:.3g}) as large for {its['to']} as for {its['from']}"
            )
        texts.append(f"{system}: {text}" if system else text)
    return "; ".join(texts)


def amounts(entry: Mapping) -> str:
    """A damage in the words of the configuration, without their keys."""
    values = (", ".join(each) if isinstance(each, list) else each for each in entry.values())
    return " ".join(map(str, values))
