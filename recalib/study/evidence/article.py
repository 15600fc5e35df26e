"""What the article says: each number is a result, and a sentence is there while its verdict is."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from recalib.spelling import listed
from recalib.storage import whole
from recalib.study.evidence import all_results, choices, deviations, findings, readme
from recalib.study.evidence.needs import Request
from recalib.study.evidence.results import Evidence
from recalib.study.evidence.verdicts import Verdict


def needs(ask: Request) -> None:
    """What the article reads."""
    for page in (readme, all_results, findings, choices, deviations):
        page.needs(ask)


def _counted(claims: Iterable[Mapping]) -> str:
    """How many claims have each verdict."""
    verdicts = [claim["verdict"] for claim in claims]
    counts = {each: verdicts.count(each) for each in Verdict}
    return listed((f"{count} {each}" for each, count in counts.items() if count), "and")


def context(evidence: Evidence) -> dict:
    """Everything that the article may say."""
    found, results, front = (page.context(evidence) for page in (findings, all_results, readme))
    return found | {
        "headline": front["headline"],
        "percent": front["percent"],
        "by": {
            each: [claim for claim in found["claims"] if claim["verdict"] == each]
            for each in Verdict
        },
        "of": front["claims"],
        "counted": _counted(found["claims"]),
        "sentences": front["sentences"],
        "readings": front["readings"],
        "own": results["own"],
        "typical": results["typical"],
        "published_errors": results["published"],
        "choices": choices.context(evidence),
        "deviations": deviations.context(evidence)["deviations"],
    }


def typeset(source: Path, article: Path, project: Path = Path()) -> None:
    """Write the article, tagged for screen readers, with the fonts of its figures alone.

    Args:
        source: in Typst, below the project's folder.
        article: a PDF.

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
