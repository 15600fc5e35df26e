"""What the article says: each number is a result, and a sentence is there while its verdict is."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from recalib.files.storage import whole
from recalib.spelling import listed
from replication.config.shipped import REFERENCE
from replication.judgement.reference import one_search
from replication.judgement.results import Evidence
from replication.judgement.verdicts import Verdict
from replication.pages import all_results, choices, deviations, findings, readme

NEEDS = " ".join(its.NEEDS for its in (readme, all_results, findings, choices, deviations))


def _counted(claims: Iterable[Mapping]) -> str:
    """How many claims have each verdict."""
    verdicts = [claim["verdict"] for claim in claims]
    counts = {verdict: verdicts.count(verdict) for verdict in Verdict}
    return listed((f"{count} {verdict}" for verdict, count in counts.items() if count), "and")


def context(evidence: Evidence) -> dict:
    """Everything that the article may say."""
    found, results, front = (page.context(evidence) for page in (findings, all_results, readme))
    return found | {
        "by": {
            verdict: [claim for claim in found["claims"] if claim["verdict"] == verdict]
            for verdict in Verdict
        },
        "of": front["claims"],
        "counted": _counted(found["claims"]),
        "sentences": front["sentences"],
        "readings": front["readings"],
        "ways": front["ways"],
        "once": one_search(evidence.table(REFERENCE)["schedule_improved"]),
        "own": results["own"],
        "typical": results["typical"],
        "published_errors": results["published"],
        "choices": choices.context(evidence),
        "deviations": deviations.context(evidence)["deviations"],
    }


def typeset(source: Path, article: Path, project: Path = Path()) -> None:
    """Write the article as a PDF, tagged for screen readers, with the fonts of its figures alone.

    The source, in Typst, lies below the project's folder.

    Raises typst.TypstError: a reference, a figure or a sign that Typst does not know.
    """
    import matplotlib
    import typst

    with whole(article) as temporary:
        typst.compile(
            source,
            output=temporary,
            root=project,
            format="pdf",
            font_paths=[Path(matplotlib.get_data_path(), "fonts", "ttf")],
            ignore_system_fonts=True,
            pdf_standards=["ua-1"],
        )
