"""The data model of findings about claims, which are written to and read from a file."""

from pathlib import Path

import numpy as np
from pydantic import TypeAdapter

from replication.config.part import Frozen
from replication.judgement.hierarchy import Estimate, Model
from replication.judgement.verdicts import Verdict

DIGITS = 6  # significant digits: enough that pages, which show fewer, round correctly


class Number(Frozen):
    """A number with its intervals."""

    name: str  # a description of the quantity
    system: str  # the algorithm that is measured; empty if the name contains it
    value: float  # the number, or a bound if only that is known
    interval: tuple[float, float] | None = None  # 95 %, of the mean over setups or over runs
    # the interval of the number in one more study with another setup
    predictive_interval: tuple[float, float] | None = None
    bound: str | None = None  # "at least" or "at most", if the value is a bound


class Spread(Frozen):
    """The variation of a number between setups: standard deviations of its logarithm."""

    between: float  # between setups, without the variation between replicates
    between_interval: tuple[float, float]
    luck: float  # between measurements of the same setup
    luck_interval: tuple[float, float]
    setups: int  # number of setups with a measurement
    unsettled: int  # number of searches that have not converged
    shares: dict[str, float]  # the share of setups with each effect
    factor: str | None = None  # the factor with the strongest effect, if it is significant


class Finding(Frozen):
    """A claim of the paper, its measurements, and the verdict."""

    id: str  # the claim's name
    section: str  # the section of the paper
    statement: str  # a quotation from the paper
    claim: str  # the claim in one sentence
    published: str | None  # the paper's number, if any
    criterion: str  # the condition that supports the claim
    estimates: tuple[Number, ...]  # numbers; the first one decides
    spread: Spread | None  # variation between setups, if these decide
    verdict: Verdict  # on the claim
    note: str  # further remarks


_FINDINGS = TypeAdapter(tuple[Finding, ...])


def read_findings(path: Path) -> dict[str, Finding]:
    """The findings in a file, by the ids of their claims."""
    return {finding.id: finding for finding in _FINDINGS.validate_json(path.read_bytes())}


def written(findings: tuple[Finding, ...]) -> bytes:
    """The content of a file of findings."""
    return _FINDINGS.dump_json(findings, indent=2) + b"\n"


def number(name: str, system: str, estimate: Estimate, another: Estimate | None = None) -> Number:
    """A positive number, from the estimate of its logarithm."""
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
    """The variation of a number between setups, from its model."""
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
    """The value with `DIGITS` significant digits."""
    return float(f"{value:.{DIGITS}g}")
