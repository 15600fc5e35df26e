"""Write the pages of a study from their templates, and publish the pages of the shipped study.

All measured numbers come from results; none is typed.
"""

import re
import shutil
from collections.abc import Sequence
from pathlib import Path

import yaml
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from recalib.files.storage import whole
from replication.config.study import Study
from replication.pages import formats, guidance
from replication.pages.contents import Contents
from replication.plots.figures import Figure

TEMPLATES = "workflow/templates"
MARKUP = re.compile(r"[\\*_`$#@<>\[\]~]|//")  # Typst's markup, which is plain text in results


def write(
    study: Study, pages: Sequence[Path], figures: Sequence[Path] = (), project: Path = Path()
) -> None:
    """Write pages, each from the template of its name. Templates show only the given figures."""
    contents = Contents(study, figures, project)
    for path in pages:
        text = render(path.name, contents)
        with whole(path) as temporary:
            temporary.write_text(text, encoding="utf-8")


def publish(sources: Sequence[Path], copies: Sequence[Path]) -> None:
    """Copy files to their committed places, each completely or not at all."""
    for source, copy in zip(sources, copies, strict=True):
        with whole(copy) as temporary:
            shutil.copyfile(source, temporary)


def render(page: str, contents: Contents) -> str:
    """The text of a page."""
    typeset = page.endswith(".typ")
    environment = Environment(
        loader=FileSystemLoader(contents.project / TEMPLATES),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=typeset,  # the text of a macro is then Markup and not escaped again
        finalize=_escaped if typeset else None,
    )
    environment.filters["quoted"] = _quoted
    environment.globals |= {name: form for name, form in vars(formats).items() if callable(form)}
    figures = yaml.safe_load((contents.project / TEMPLATES / "figures.yaml").read_text("utf-8"))
    environment.globals |= {
        "Figure": Figure,
        "title": lambda figure: figures[figure.name]["title"],
        "caption": lambda figure: figures[figure.name]["caption"].format(study=contents.study),
        "on_real_arm": guidance.on_real_arm,
        "ends": guidance.ends_on_twin,
    }
    return environment.get_template(f"{page}.j2").render(results=contents, study=contents.study)


def _quoted(value: str) -> Markup:
    """A string literal in Typst code."""
    text = value.replace("\\", "\\\\").replace('"', '\\"')
    return Markup(f'"{text}"')


def _escaped(value: object) -> Markup:
    """A value as text, with Typst's markup escaped."""
    if isinstance(value, Markup):
        return value
    return Markup(MARKUP.sub(lambda sign: "\\" + "\\".join(sign[0]), str(value)))
