"""The paper's claims, in the order of the paper: a file for each section.

Changes after a result had been seen are listed in `workflow/deviations.yaml`.
"""

from contextlib import suppress
from dataclasses import replace

from replication.config.study import Study
from replication.judgement.claims import (
    section_3,
    section_4,
    section_5,
    section_6,
    section_7,
    section_8,
)
from replication.judgement.claims.claim import Claim
from replication.judgement.claims.claim import Measured as Measured
from replication.judgement.claims.claim import OfSetups as OfSetups
from replication.judgement.claims.claim import Statement as Statement
from replication.judgement.claims.section_5 import integral_ratios as integral_ratios
from replication.judgement.evidence import Evidence, NotMeasured
from replication.judgement.findings import Finding, written


def claims(study: Study) -> list[Claim]:
    """All claims of the paper."""
    iterations, late = study.experiments.iterations, study.campaign.late
    sections = {
        "3": section_3.claims(iterations),
        "4": section_4.claims(iterations, late),
        "5": section_5.claims(iterations),
        "6": section_6.claims(iterations),
        "7": section_7.claims(iterations),
        "8": section_8.claims(iterations),
    }
    return [
        replace(claim, section=claim.section or section)
        for section, found in sections.items()
        for claim in found
    ]


def judge(evidence: Evidence) -> tuple[Finding, ...]:
    """The findings about all claims for which the study has the necessary results."""
    findings = []
    for claim in claims(evidence.study):
        with suppress(NotMeasured):
            findings.append(claim.judge(evidence))
    return tuple(findings)


def findings_of(study: Study) -> bytes:
    """The content of the file of a study's findings."""
    return written(judge(Evidence(study)))
