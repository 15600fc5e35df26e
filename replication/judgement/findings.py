"""What was found about each claim: typed, written and read by one model."""

from pathlib import Path

import numpy as np
from pydantic import TypeAdapter

from replication.config.part import Frozen
from replication.judgement.hierarchy import Estimate, Model
from replication.judgement.verdicts import Verdict

DIGITS = 6  # more than pages show: rounding twice is rounding once


class Number(Frozen):
    """A number with its intervals."""

    name: str  # what it is
    system: str  # the algorithm that it is measured on; empty if the name says it
    value: float  # the number, or its bound if only that is known
    interval: tuple[float, float] | None = None  # 95 % of the mean over setups, or of runs
    # in which one more study in another setup would find its number
    predictive_interval: tuple[float, float] | None = None
    bound: str | None = None  # "at least" or "at most", if the value is one


class Spread(Frozen):
    """By how much a number differs from setup to setup: standard deviations of its logarithm."""

    between: float  # between setups, without the variation between replicates
    between_interval: tuple[float, float]
    luck: float  # between measurements of the same setup, and its interval
    luck_interval: tuple[float, float]
    setups: int  # how many measured it
    unsettled: int  # how many of its searches have not converged
    shares: dict[str, float]  # the share of setups with each effect
    factor: str | None = None  # what it depends on most, beyond chance


class Finding(Frozen):
    """A claim of the paper, its measurements, and the verdict."""

    id: str  # the claim's name
    section: str  # the section of the paper
    statement: str  # the paper's own words
    claim: str  # what they say, in a sentence
    published: str | None  # the paper's number, if any
    criterion: str  # what supports the claim
    estimates: tuple[Number, ...]  # numbers; the first one decides
    spread: Spread | None  # over the setups, if they decide
    verdict: Verdict  # on the claim
    note: str  # what else there is to say


_FINDINGS = TypeAdapter(tuple[Finding, ...])


def read_findings(path: Path) -> dict[str, Finding]:
    """The findings in a file, by the ids of their claims."""
    return {finding.id: finding for finding in _FINDINGS.validate_json(path.read_bytes())}


def written(findings: tuple[Finding, ...]) -> bytes:
    """The text of a file of findings."""
    return _FINDINGS.dump_json(findings, indent=2) + b"\n"


def number(name: str, system: str, estimate: Estimate, another: Estimate | None = None) -> Number:
    """A number above zero from the estimate of its logarithm."""
    return Number(
        name=name,
        system=system,
        value=rounded(np.exp(estimate.mean)),
        interval=_ends(estimate),
        predictive_interval=_ends(another) if another else None,
    )


def spread(
    model: Model, unsettled: int, shares: dict[Verdict, float], factor: str | None
) -> Spread:
    """How a number differs from setup to setup."""
    between, luck = (Estimate(*map(rounded, part)) for part in (model.heterogeneity, model.luck))
    return Spread(
        between=between.mean,
        between_interval=between[1:],
        luck=luck.mean,
        luck_interval=luck[1:],
        setups=len(model.numbers),
        unsettled=unsettled,
        shares={str(verdict): rounded(share) for verdict, share in shares.items()},
        factor=factor,
    )


def _ends(estimate: Estimate) -> tuple[float, float]:
    return rounded(np.exp(estimate.low)), rounded(np.exp(estimate.high))


def rounded(value: float) -> float:
    """With so many more digits than pages show."""
    return float(f"{value:.{DIGITS}g}")
