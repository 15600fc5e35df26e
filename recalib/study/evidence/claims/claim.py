"""What a claim is: one home of all that is said of it, and how it is judged."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from recalib.study.evidence.claims.across import Across, Share, over_all
from recalib.study.evidence.needs import Request
from recalib.study.evidence.results import Evidence
from recalib.study.statistics import Estimate

SUPPORTED, NOT_SUPPORTED, UNDECIDED = "supported", "not supported", "undecided"
WORDS = {0.1: "tenth", 0.25: "quarter", 2.0: "twice", 3.0: "three"}


class Limit(float):
    """A number that decides; texts say it as `word`, `percent` or `central` share."""

    def __format__(self, how: str) -> str:
        match how:
            case "word":
                return WORDS[self]
            case "percent":
                return f"{100 * self:g} %"
            case "central":
                return f"{100 * (1 - 2 * self):g} %"
        return super().__format__(how or "g")


def below(estimate: Estimate, limit: float) -> bool | None:
    """Whether the whole interval is below the limit; None where the limit is inside of it."""
    if estimate.high < limit:
        return True
    return False if estimate.low > limit else None


def above(estimate: Estimate, limit: float) -> bool | None:
    """Whether the whole interval is above the limit; None where the limit is inside of it."""
    if estimate.low > limit:
        return True
    return False if estimate.high < limit else None


def every(judged: Iterable[bool | None]) -> bool | None:
    """Whether all hold: not where one does not, and nobody knows where one is undecided."""
    judged = list(judged)
    if False in judged:
        return False
    return None if None in judged else True


def somewhere(judged: Iterable[bool | None]) -> bool | None:
    """Whether it holds somewhere, and nowhere does the reverse; the reverse is judged alike."""
    judged = set(judged) - {None}
    return judged.pop() if len(judged) == 1 else None


def verdict(holds: bool | None) -> str:
    """In a word."""
    return {True: SUPPORTED, False: NOT_SUPPORTED, None: UNDECIDED}[holds]


@dataclass
class Finding:
    """What was measured.

    Attributes:
        holds: whether the criterion does; None where what was measured cannot tell. By system,
            where a claim is about several.
        measured: numbers by label.
        interval: of those that have one.
        note: what else there is to say.
    """

    holds: bool | dict[str, bool | None] | None
    measured: dict[str, float]
    interval: dict[str, tuple[float, float]] = field(default_factory=dict)
    note: str = ""

    @classmethod
    def of(
        cls,
        holds: bool | dict[str, bool | None] | None,
        estimates: Mapping[str, Estimate],
        note: str = "",
        **others: float,
    ) -> "Finding":
        """A finding of estimates, and of numbers without an interval."""
        means = {label: estimate.mean for label, estimate in estimates.items()}
        intervals = {label: (each.low, each.high) for label, each in estimates.items()}
        return cls(holds, means | others, intervals, note)

    @property
    def systems(self) -> dict[str, bool | None]:
        """Whether the criterion holds, by system; that of a claim about a single one has no name.

        Undecided where a number is missing: a comparison with NaN is false, and says nothing.
        """
        numbers = [*self.measured.values(), *sum(self.interval.values(), start=())]
        known = not np.isnan(numbers).any()
        by_system = self.holds if isinstance(self.holds, dict) else {"": self.holds}
        return {system: holds if known else None for system, holds in by_system.items()}


@dataclass(frozen=True)
class Claim:
    """A claim of the paper. Texts may name limits and facts in braces.

    Attributes:
        id: its name.
        section: of the paper.
        statement: what the paper says.
        short: the same in a line, with a place for the first of the numbers measured.
        published: its number, if any.
        limits: the numbers that decide; figures draw them, too.
        criterion: what would support the claim.
        reason: why just that would; it may name limits alone.
        needs: asks for what `measure` reads.
        measure: from evidence and limits to what was found.
        across: how it is measured in a universe, by system; empty where nothing can vary it.
        figures: that show it.
    """

    id: str
    section: str
    statement: str
    short: str
    published: str
    limits: Mapping[str, Limit]
    criterion: str
    reason: str
    needs: Callable[[Request], None]
    measure: Callable[[Evidence, Mapping[str, Limit]], Finding]
    across: Mapping[str, Across] = field(default_factory=dict)
    figures: tuple[str, ...] = ()

    def judge(self, evidence: Evidence) -> dict:
        """What was measured and the verdict, as the contract of claims.json has them."""
        finding = self.measure(evidence, self.limits)
        shares = self.shares(evidence)
        judged = {
            system: over_all(home, shares.get(system)) for system, home in finding.systems.items()
        }

        def said(text: str) -> str:
            return text.format(**self.limits, **evidence.facts)

        return {
            "id": self.id,
            "section": self.section,
            "statement": said(self.statement),
            "published": said(self.published),
            "measured": {label: _number(value) for label, value in finding.measured.items()},
            "interval": {
                label: [_number(low), _number(high)]
                for label, (low, high) in finding.interval.items()
                if not np.isnan([low, high]).any()  # that of a single search
            },
            "criterion": said(self.criterion),
            "verdict": verdict(somewhere(judged.values())),
            "note": finding.note,
            "universes": next((share.said for share in shares.values()), None),
            "systems": {
                system: {
                    "verdict": verdict(each),
                    "universes": shares[system].said if shares else None,
                }
                for system, each in judged.items()
                if system
            },
        }

    def ask(self, request: Request) -> None:
        """Ask for all that judging it reads."""
        self.needs(request)
        if self.across and request.outcomes():
            request.fact("seed")

    def shares(self, evidence: Evidence) -> dict[str, Share]:
        """In how many universes it holds, by system; empty for a study without universes."""
        outcomes = evidence.outcomes() if self.across else None
        if outcomes is None:
            return {}
        from recalib.study.evidence.effects import effects

        found = {}
        for system, across in self.across.items():
            holds = across.holds(outcomes, self.limits[across.limit])
            luck = evidence.rng("effects", self.id, system)
            strongest = effects(outcomes[across.column], evidence.design(), luck).iloc[0]
            found[system] = Share(int(holds.sum()), len(holds), strongest)
        return found


def _number(value: float) -> float | None:
    return float(f"{value:.4g}") if np.isfinite(value) else None
