"""Pages, rendered from templates: no measured number in them is typed."""

import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

from recalib.study.evidence import (
    all_results,
    article,
    choices,
    deviations,
    findings,
    guidance,
    readme,
    real_arm,
)
from recalib.study.evidence.needs import Request
from recalib.study.evidence.results import Evidence


class Page(NamedTuple):
    """A page: what it reads, and what its template may say."""

    needs: Callable[[Request], None]
    context: Callable[[Evidence], dict]


PAGES: Mapping[str, Page] = {
    "README.md": Page(readme.needs, readme.context),
    "results.md": Page(all_results.needs, all_results.context),
    "choices.md": Page(choices.needs, choices.context),
    "deviations.md": Page(deviations.needs, deviations.context),
    "findings.md": Page(findings.needs, findings.context),
    "guidance.md": Page(guidance.needs, guidance.context),
    "real_arm.md": Page(real_arm.needs, real_arm.context),
    "article.typ": Page(article.needs, article.context),
}
MARKUP = re.compile(r"[\\*_`$#@<>\[\]~]|//")  # of Typst: in a result it is text


def page(name: str, evidence: Evidence, template: Path) -> str:
    """The text of one of `PAGES`."""
    return render(template, PAGES[name].context(evidence))


def render(template: str | Path, context: Mapping) -> str:
    """The text of a page."""
    import jinja2

    in_typst = Path(template).name.endswith(".typ.j2")
    environment = jinja2.Environment(
        undefined=jinja2.StrictUndefined,
        keep_trailing_newline=True,
        finalize=_escaped if in_typst else None,
    )
    return environment.from_string(Path(template).read_text(encoding="utf-8")).render(context)


def _escaped(value: object) -> object:
    """A value whose signs are no markup of Typst."""
    return MARKUP.sub(lambda sign: "\\" + "\\".join(sign[0]), str(value))
