"""What the pages of the report say."""

import platform
import re
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

from recalib.files.storage import whole
from replication.judgement.claims import CLAIMS
from replication.judgement.results import Evidence
from replication.pages.words import learner, one, ranged

if TYPE_CHECKING:
    import pandas as pd
    from jinja2 import Environment

TEXTS = "workflow/report"
PACKAGES = (
    "snakemake",
    "pin",
    "example-robot-data",
    "numpy",
    "scipy",
    "pandas",
    "matplotlib",
    "rerun-sdk",
)
TABLES = "damages", "errors", "settings", "versions"
READ = "findings", "choices", "results"  # pages of a study with evidence, as they are in docs/
EXPLAINED = "ideas"  # the page of the method
# Committed: other targets than the default one write them.
KEPT = {"guidance": "figure12", "real_arm": "figure13"}
NEEDS = """
    summary.csv scenarios/*.json search/*.csv claims.json improved learners scenario scenarios
    elsewhere published iterations tests measure_every assignment_poses coupling_poses
    balls points
"""
FRONT = "front"  # the text before all pages


def heading(page: str, project: Path) -> str:
    """The heading of a page's text."""
    if page in (*READ, EXPLAINED, *KEPT):
        text = (project / "docs" / f"{page}.md").read_text(encoding="utf-8")
        return next(line for line in text.splitlines() if line.startswith("# ")).removeprefix("# ")
    text = (project / TEXTS / f"{page}.html").read_text(encoding="utf-8")
    return text.splitlines()[0].removeprefix("<h1>").removesuffix("</h1>")


def context(evidence: Evidence) -> dict:
    """Everything that the pages may say."""
    from replication.training.settings import best

    summary = evidence.table("summary.csv").to_dict("records")
    runs = {(run["scenario"], run["learner"]): run for run in summary}
    samples = {learner: evidence.sample(learner) for _, learner in runs}
    one = next(iter(samples.values()))
    return {
        **evidence.facts,
        "own": runs.get((evidence.facts["scenario"], evidence.facts["improved"])),
        "runs": runs,
        "settings": {learner: _spread(best(sample)) for learner, sample in samples.items()},
        "rounds": one["round"].nunique(),
        "trials": int((one["round"] == 1).sum()) // one["search"].nunique(),
        "resolved": [
            evidence.scenario(scenario) for scenario in dict.fromkeys(name for name, _ in runs)
        ],
        "claims": evidence.claims(),
        "versions": {"Python": platform.python_version()}
        | {name: version(name) for name in PACKAGES},
    }


def _spread(winners: "pd.DataFrame") -> dict[str, str]:
    """The least and the largest of each number."""
    return {name: f"{values.min():.2g} to {values.max():.2g}" for name, values in winners.items()}


def drawing(path: str | Path):
    """A drawing as a part of a page, without what only a file of its own needs."""
    from markupsafe import Markup

    text = Path(path).read_text(encoding="utf-8")
    return Markup(f'<span class="drawing">{text[text.index("<svg") :]}</span>')


def shown_by(figure: str, claims: Sequence[dict]) -> list[dict]:
    """The judged claims that a figure shows."""
    ids = {claim.id for claim in CLAIMS if figure in claim.figures}
    return [claim for claim in claims if claim["id"] in ids]


def layout() -> "Environment":
    """Where the texts of the pages lie."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    texts = Environment(
        loader=FileSystemLoader(TEXTS),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    texts.globals |= {"one": one, "ranged": ranged, "learner": learner}  # words as on all pages
    return texts


def page(name: str, known: dict, figures: dict[str, str]) -> str:
    """The text of a page from what `context` knows, and from the paths of figures by name."""
    own = {"page": f"{name}.html", "shown": shown_by(name, known["claims"]), "body": None}
    own["figure"] = drawing(figures[name]) if name in figures else None
    return layout().get_template("layout.html").render(known | own)


def from_markdown(text: str, figures: dict[str, str]) -> str:
    """A page of docs/, in Markdown, as one of the report.

    Its figures are drawn into it. Its links to other pages lose their ends, which are not in it.
    """
    from markdown import markdown
    from markupsafe import Markup

    html = markdown(text, extensions=["tables", "fenced_code", "sane_lists"])
    html = re.sub(
        r'<img alt="([^"]*)" src="[^"]*?(\w+)\.png" />',
        lambda image: drawing(figures[image[2]]) if image[2] in figures else f"<p>{image[1]}</p>",
        html,
    )
    html = re.sub(r'<a href="(?!https?:)[^"]*">(.*?)</a>', r"\1", html, flags=re.DOTALL)
    return layout().get_template("layout.html").render(body=Markup(html))


def write(
    evidence: Evidence,
    pages: list[Path],
    rst: Path,
    read: Sequence[Path] = (),
    figures: Sequence[Path] = (),
) -> None:
    """Write the pages of a study's report, and the text before them.

    A page with the name of one that is `read`, or kept in docs/, shows that.
    """
    known = context(evidence)
    drawings = {path.stem: str(path) for path in figures}
    drawings |= {name: f"figures/{name}.svg" for name in KEPT.values()}
    texts = {path.stem: path for path in read} | {name: Path(f"docs/{name}.md") for name in KEPT}
    for output in pages:
        if output.stem in texts:
            text = from_markdown(texts[output.stem].read_text(encoding="utf-8"), drawings)
        else:
            text = page(output.stem, known, drawings)
        with whole(output) as path:
            path.write_text(text, encoding="utf-8")
    with whole(rst) as path:
        path.write_text(front(known, drawings), encoding="utf-8")


def front(known: dict, figures: dict[str, str]) -> str:
    """The text before all pages, which Snakemake completes. Arguments as those of `page`."""
    return layout().get_template(f"{FRONT}.rst").render(known | {"figures": figures})
