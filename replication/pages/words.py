"""Numbers and results in words, for pages."""

import re
from collections.abc import Mapping, Sequence

import numpy as np

from replication.config.switches import IMPROVED, RITTER, SWITCHES
from replication.judgement.intervals import Estimate
from replication.judgement.needs import DOUBLE
from replication.judgement.results import Words
from replication.training.measured import ERRORS, UNITS

LEARNERS = {
    IMPROVED: "Improved system",
    RITTER: "Ritter's map",
    DOUBLE: "Ritter's map, cells of both maps",
    **{its.without: f"Improved system without {its.label}" for its in SWITCHES},
    **{its.added: f"Ritter's map with {its.label}" for its in SWITCHES},
}


def learner(name: str) -> str:
    """A training in words; a column of its own says for how many iterations it was tuned."""
    kind = re.sub(r"_\d+$", "", name)
    return LEARNERS.get(kind, kind.replace("_", " ").capitalize())


def n(value: float, digits: int = 2) -> str:
    """A number for people."""
    if 0 < abs(value) < 10**-digits:
        return _rounding(value) or f"{value:.1e}"
    return f"{value:.{digits}f}"


def _rounding(value: float) -> str:
    """Says of a number that it is what the arithmetic leaves: each machine's differs."""
    return "below 1e-6" if 0 < abs(value) <= 1e-6 else ""


def short(value: float) -> str:
    """A number with three digits."""
    return _rounding(value) or f"{value:.3g}"


def percent(value: float) -> str:
    """A share."""
    return _rounding(value) or f"{float(f'{100 * value:.2g}'):g} %"


def ranged(middle: float, bounds: Sequence[float], said=short) -> str:
    """A number with its interval."""
    low, high = map(said, bounds)
    return f"{said(middle)} ({low} to {high})" if low != high else said(middle)


def estimated(estimate: Estimate, longest: float = np.inf) -> str:
    """An estimate with its interval; beyond the end of what was tried stand bounds."""

    def number(value: float) -> str:
        return f"more than {longest:g}" if value > longest else short(value)

    if np.isnan(estimate.mean):
        return "not known"
    if np.isnan(estimate[1:]).any():
        return number(estimate.mean)
    return ranged(estimate.mean, estimate[1:], number)


def pair(row: Mapping, moment: str) -> str:
    """Both errors of a summary's row at the beginning or the end."""
    errors = (row[f"{moment}_{error}"] for error in ERRORS)
    return ", ".join(f"{n(error)} {unit}" for error, unit in zip(errors, UNITS, strict=True))


def one(claim: Mapping, label: str, said=short) -> str:
    """One of the numbers measured for a claim, with its interval; bounds are called so."""
    bounds = claim["bounds"].get(label, ())

    def number(value: float, part: str) -> str:
        text = said(value)
        return f"{'at least' if value > 1 else 'at most'} {text}" if part in bounds else text

    text = number(claim["measured"][label], "mean")
    if label in claim["interval"]:
        low, high = claim["interval"][label]
        text += f" ({number(low, 'low')} to {number(high, 'high')})"
    return text


def measured(claim: Mapping) -> str:
    """What was measured for a claim in the reference study, with intervals."""
    return "; ".join(f"{label}: {one(claim, label)}" for label in claim["measured"])


def judged_by_setups(claim: Mapping) -> bool:
    """Whether the mean over the setups is its number; the factor is the reference study's."""
    return claim["universes"]["status"] == "measured" and claim["id"] != "speed-up"


def headline(claim: Mapping, said=short) -> str:
    """The number that judges a claim, with its interval: over the setups where they judge it."""
    its = claim["universes"]
    if judged_by_setups(claim):
        return ranged(its["mean"], its["mean_interval"], said)
    return one(claim, next(iter(claim["measured"])), said)


def typical_errors(claim: Mapping) -> str:
    """Where the typical search ends, as the claim about Figure 1 has it."""
    errors = (claim["measured"][f"final error [{unit}]"] for unit in UNITS)
    return " and ".join(f"{n(error)} {unit}" for error, unit in zip(errors, UNITS, strict=True))


def verdicts(claim: Mapping) -> str:
    """The verdict on a claim, and that on each other system beside it."""
    judged = f" ({next(iter(claim['systems']))})" if len(claim["systems"]) > 1 else ""
    return "; ".join([f"**{claim['verdict']}**{judged}", *of_others(claim)])


def of_others(claim: Mapping) -> list[str]:
    """Each system on which a claim has another verdict than on the one that judges it."""
    return [
        f"{system}: {its['verdict']}"
        for system, its in claim["systems"].items()
        if its["verdict"] != claim["verdict"]
    ]


def over_setups(its: Mapping) -> str:
    """Mean, heterogeneity and luck over the alternative setups."""
    low, high = map(short, its["another_setup"])
    text = (
        f"{ranged(its['mean'], its['mean_interval'])};"
        f" heterogeneity {ranged(its['heterogeneity'], its['heterogeneity_interval'])},"
        f" luck {short(its['luck'])},"
        f" another setup {low if low == high else f'{low} to {high}'}"
    )
    if its["setups_left_out"]:
        text += f"; known in {its['setups']} of {its['setups'] + its['setups_left_out']}"
    if "holds" in its:
        text += (
            f"; holds in {its['holds']} of {its['setups']}"
            f" ({its['holds_by_luck_alone']:.1f} expected from luck alone)"
        )
    return text


def level_in_words(words: Mapping[str, str], level: object) -> str:
    """A level of a factor with these words; another study's robots go by their names."""
    return words.get(str(level), str(level))


def depends(factors: Words, its: Mapping) -> str:
    """The choice that moves a claim's number most, and by how much; empty if not beyond chance."""
    its = its["depends_on"]
    if its["effect"] <= its["chance"]:
        return ""
    words, effect = factors[its["factor"]], ranged(its["effect"], its["interval"])
    least, largest = (level_in_words(words, its[key]) for key in ("from", "to"))
    return f" Largest effect: {effect} where {words['asks']} {largest}, not {least}."


def amounts(entry: Mapping) -> str:
    """A damage in the words of the configuration, without their keys."""
    values = (", ".join(value) if isinstance(value, list) else value for value in entry.values())
    return " ".join(map(str, values))
