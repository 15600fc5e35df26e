"""Pages, rendered from templates: no measured number in them is typed."""

import re
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType

from replication.judgement.results import Evidence
from replication.pages import (
    all_results,
    article,
    choices,
    deviations,
    findings,
    guidance,
    readme,
    real_arm,
    words,
)

# Each says what it NEEDS, and in its `context` what its template may say.
PAGES: Mapping[str, ModuleType] = {
    "README.md": readme,
    "results.md": all_results,
    "choices.md": choices,
    "deviations.md": deviations,
    "findings.md": findings,
    "guidance.md": guidance,
    "real_arm.md": real_arm,
    "article.typ": article,
    "index.md": readme,
}
MARKUP = re.compile(r"[\\*_`$#@<>\[\]~]|//")  # of Typst: in a result it is text


def page(name: str, evidence: Evidence, template: Path) -> str:
    """The text of one of `PAGES`."""
    return render(template, PAGES[name].context(evidence))


def render(template: str | Path, context: Mapping) -> str:
    """The text of a page, which has the functions of `words` besides."""
    import jinja2

    in_typst = Path(template).name.endswith(".typ.j2")
    environment = jinja2.Environment(
        undefined=jinja2.StrictUndefined,
        keep_trailing_newline=True,
        finalize=_escaped if in_typst else None,
    )
    environment.globals.update({name: its for name, its in vars(words).items() if callable(its)})
    return environment.from_string(Path(template).read_text(encoding="utf-8")).render(context)


def _escaped(value: object) -> object:
    """A value whose signs are no markup of Typst."""
    return MARKUP.sub(lambda sign: "\\" + "\\".join(sign[0]), str(value))
