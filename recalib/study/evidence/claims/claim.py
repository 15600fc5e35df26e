"""What a claim is: one home of all that is said of it, and how it is judged."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from recalib.errors import UnknownName
from recalib.study.configuration.shipped import REFERENCE
from recalib.study.evidence.claims.across import (
    CANNOT_VARY,
    NO_MEAN,
    NOT_MEASURED,
    Across,
    Setups,
    rounded,
)
from recalib.study.evidence.results import Evidence
from recalib.study.evidence.verdicts import Verdict
from recalib.study.inference.intervals import UNKNOWN, Estimate

WORDS = {0.1: "tenth", 0.25: "quarter", 0.5: "half", 2.0: "twice", 3.0: "three"}


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


def of_all(*verdicts: Verdict) -> Verdict:
    """The verdict on a claim of several parts: that on the first which is not supported."""
    return next((its for its in verdicts if its is not Verdict.SUPPORTED), Verdict.SUPPORTED)


@dataclass
class Finding:
    """What was measured in the study itself.

    Attributes:
        estimates: numbers with their intervals, by label.
        verdict: of what is no matter of `Across`; None where the setups judge.
        numbers: others, by label.
        note: what else there is to say.
        ends: of what could be measured, by label: below and above stand bounds.
    """

    estimates: Mapping[str, Estimate] = field(default_factory=dict)
    verdict: Verdict | None = None
    numbers: Mapping[str, float] = field(default_factory=dict)
    note: str = ""
    ends: Mapping[str, tuple[float, float]] = field(default_factory=dict)

    def said(self) -> dict:
        """As the contract of claims.json has it.

        A bound is the end of what could be measured, and `bounds` says which numbers are bounds. An
        interval that is not known, as that of a single search or of an extreme, is left out.
        """
        measured, interval, bounds = {}, {}, {}
        for label, estimate in self.estimates.items():
            least, most = self.ends.get(label, (-np.inf, np.inf))
            within = [
                least if np.isnan(value) or value < least else min(value, most)
                for value in estimate
            ]
            known = label in self.ends or estimate.low < estimate.high
            measured[label] = within[0]
            if known:
                interval[label] = [rounded(bound) for bound in within[1:]]
            parts = [
                name
                for name, number in zip(estimate._fields, within, strict=True)
                if number in (least, most)
            ]
            if parts:
                bounds[label] = parts
        return {
            "measured": {
                label: rounded(value) for label, value in {**measured, **self.numbers}.items()
            },
            "interval": interval,
            "bounds": bounds,
            "note": self.note,
        }


@dataclass(frozen=True)
class Claim:
    """A claim of the paper. Texts may name limits and facts in braces.

    Attributes:
        id: its name.
        section: of the paper.
        quotation: the paper's own words.
        statement: what they say, in a sentence.
        short: the number in words, with a place for it.
        published: the paper's number, if any.
        criterion: what would support the claim.
        reason: why just that would.
        limits: the numbers that decide; figures draw them, too.
        across: how it is measured in a setup, by system: first the one on which the paper makes it.
        needs: what `measure` reads; see `recalib.study.evidence.needs`.
        measure: from evidence and limits to what was found in the study itself. Estimates by the
            names of the systems are compared as the setups are.
        figures: that show it.
    """

    id: str
    section: str
    quotation: str
    statement: str
    short: str
    criterion: str
    reason: str
    published: str = "no number"
    limits: Mapping[str, Limit] = field(default_factory=dict)
    across: Mapping[str, Across] = field(default_factory=dict)
    needs: str = ""
    measure: Callable[[Evidence, Mapping[str, Limit]], Finding] | None = None
    figures: tuple[str, ...] = ()

    @property
    def all_needs(self) -> str:
        """All that judging it reads."""
        setups = {f"{across.table}?" for across in self.across.values()}
        needs = [self.needs, *(["seed", *setups] if setups else [])]
        return " ".join(needs if self.measure else [*needs, REFERENCE])

    def judge(self, evidence: Evidence) -> dict:
        """What was measured and the verdict, as the contract of claims.json has them.

        Raises UnknownName: a system of `across` that the study does not measure.
        """
        finding = self.measure(evidence, self.limits) if self.measure else self._from(evidence)
        setups = self.setups(evidence)
        systems = {
            system: {
                "verdict": str(self._verdict(system, finding, setups, evidence)),
                "universes": self._said(system, setups, evidence),
            }
            for system in self.across
        }
        judged = next(iter(systems.values()), {"verdict": "", "universes": CANNOT_VARY})
        if finding.verdict is not None:
            judged = judged | {"verdict": str(finding.verdict)}

        def said(text: str) -> str:
            return text.format(**self.limits, **evidence.facts)

        return {
            "id": self.id,
            "section": self.section,
            "quotation": self.quotation,
            "statement": said(self.statement),
            "published": said(self.published),
            "criterion": said(self.criterion),
            **finding.said(),
            **judged,
            "systems": systems,
        }

    def setups(self, evidence: Evidence) -> dict[str, Setups]:
        """The claim in all alternative setups, by system, where their mean is known."""
        found = {}
        for system, across in self.across.items():
            outcomes = evidence.setups(across.table)
            if outcomes is not None and (its := across.over(outcomes, evidence.levels())):
                found[system] = its
        return found

    def _from(self, evidence: Evidence) -> Finding:
        reference = evidence.table(REFERENCE)
        return Finding({name: its.in_reference(reference) for name, its in self.across.items()})

    def _verdict(
        self, system: str, finding: Finding, setups: Mapping[str, Setups], evidence: Evidence
    ) -> Verdict:
        """Of a system: by the setups, or by the study itself where they are not measured.

        A mean over the setups that is not known decides nothing.
        """
        if finding.verdict is None and system not in finding.estimates:
            raise UnknownName(f"system of the claim {self.id}", system, finding.estimates)
        estimate = finding.estimates.get(system, UNKNOWN)
        if system in setups:
            return setups[system].verdict(estimate)
        if self._are_measured(system, evidence):
            return Verdict.UNDECIDED
        return self.across[system].comparison.verdict(estimate)

    def _said(self, system: str, setups: Mapping[str, Setups], evidence: Evidence) -> dict:
        if system not in setups:
            return NO_MEAN if self._are_measured(system, evidence) else NOT_MEASURED
        return setups[system].said(evidence.rng("effects", self.id, system))

    def _are_measured(self, system: str, evidence: Evidence) -> bool:
        return evidence.setups(self.across[system].table) is not None
