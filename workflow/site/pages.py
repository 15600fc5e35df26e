"""The site's pages: the repository's pages in their places, and a reference from docstrings."""

import ast
import importlib
import re
from functools import cache
from pathlib import Path

from mkdocs.structure.files import File, Files

import recalib
from replication.pages.imprint import Imprint
from replication.recording.web_viewer import PAGE, embed

SHOWN = (
    "*.md",
    "docs/*.md",
    "figures/*.[psw][nve]*",
    "examples/**/*.[jp][sy]",
    "CITATION.cff",
    "config.yaml",
    "LICENSE",
    "workflow/real/*.toml",
    "workflow/site/**/*.[cj]s*",
    "docs/*.js",
)
PLACES = {"docs/index.md": "index.html", "README.md": "README.html"}  # others do not move
WIDE = "docs/index.md", "docs/try.md", "docs/watch.md"  # without side columns
BADGES = re.compile(r"^\[!\[.*\n\n", re.MULTILINE)  # images from other servers
WATCH, VIEWER = "docs/watch.md", "viewer"
# Replaces the picture on the repository's page. The viewer (35 MB) is only loaded after a click.
EMBEDDED = f"""<button type="button" class="md-button embed" data-address="../{VIEWER}/{PAGE}">
Watch the recording here (35 MB)</button>

"""
EXAMPLES = sorted((Path(recalib.__file__).parents[1] / "examples").glob("*.py"))
REFERENCE = """# Reference

`import recalib` has all these names. [The examples](library.md) show how they fit together.

| part | names |
| --- | --- |
"""
PARTS = {  # parts of recalib: title of the page, and its first example
    "nominal": ("Arms, robots and controllers", "ur10.py"),
    "damaged": ("Damages, disturbances and plants", "redundant_arm.py"),
    "loop": ("Training", "own_robot.py"),
    "learners": ("Learners", "damage_and_train.py"),
    "identification": ("Identification", "identify.py"),
    "laboratory": ("Calibration and correction", "laboratory.py"),
    "station": ("Stations", "station.py"),
    "errors": ("Errors", "save_and_load.py"),
}


def on_config(config):
    """Add a link to the repository, if the project has an address; nothing is fetched from it."""
    if repository := Imprint.read(Path(config.config_file_path).parent).repository:
        link = {"icon": "fontawesome/brands/git-alt", "link": repository, "name": "Repository"}
        config.extra["social"] = [link]
    return config


def on_files(files: Files, config) -> Files:
    """Collect all of the project's files for the site; the theme adds its own."""
    root = Path(config.config_file_path).parent
    for file in list(files):
        if file.src_dir == config.docs_dir:
            files.remove(file)
    for path in sorted(path for shown in SHOWN for path in root.glob(shown)):
        name = path.relative_to(root).as_posix()
        file = File.generated(config, name, abs_src_path=str(path))
        file.dest_uri = PLACES.get(name, file.dest_uri)
        files.append(file)
    for name, content in reference().items():
        files.append(File.generated(config, f"docs/{name}.md", content=content))
    return files


def on_page_markdown(markdown: str, page, config, files: Files) -> str:
    """Give some pages the full width, and embed the recording, if there is one."""
    if page.file.src_uri == "README.md":
        markdown = BADGES.sub("", markdown)
    if page.file.src_uri in WIDE:
        page.meta["hide"] = ["navigation", "toc"]
    if page.file.src_uri == WATCH and _recording(config).exists():
        return markdown.replace("![", f"{EMBEDDED}![", 1)
    return markdown


def on_post_build(config) -> None:
    """Add the viewer with the recording to the site."""
    if _recording(config).exists():
        embed(_recording(config), Path(config.site_dir) / VIEWER)


def _recording(config) -> Path:
    return Path(config.config_file_path).parent / config.extra["recording"]


def reference() -> dict[str, str]:
    """Reference pages by their paths in docs: an overview, and a page for each part of recalib."""
    parts = _parts()
    overview = [
        f"| [{title}](reference/{part}.md) | "
        + ", ".join(f"[`{name}`][recalib.{name}]" for name in parts[part])
        + " |\n"
        for part, (title, _) in PARTS.items()
    ]
    return {"reference": REFERENCE + "".join(overview)} | {
        f"reference/{part}": _page(part, names) for part, names in parts.items()
    }


def _page(part: str, names: list[str]) -> str:
    """The page of a part: an example, then public names, each with links to examples."""
    title, first = PARTS[part]
    (example,) = (path for path in EXAMPLES if path.name == first)
    page = [
        f"# {title}\n",
        f"{importlib.import_module(f'recalib.{part}').__doc__}\n",
        f"For example, {_link(example)}:\n",
        f"```python\n{example.read_text(encoding='utf-8')}```\n",
    ]
    for name in names:
        page += [f"::: recalib.{name}\n"]
        if used := [path for path in EXAMPLES if name in _public_names(path)]:
            page += ["In " + ", ".join(map(_link, used)) + ".\n"]
    return "\n".join(page)


def _link(example: Path) -> str:
    return f"[{example.name}](../../examples/{example.name})"


def _parts() -> dict[str, list[str]]:
    """The public names in each part of recalib, from its stub."""
    stub = ast.parse(Path(recalib.__file__).with_suffix(".pyi").read_text(encoding="utf-8"))
    parts: dict[str, list[str]] = {part: [] for part in PARTS}
    for node in stub.body:
        if isinstance(node, ast.ImportFrom) and node.module:
            parts[node.module.partition(".")[0]] += [alias.name for alias in node.names]
    return parts


@cache
def _public_names(example: Path) -> set[str]:
    """The public names that an example uses, as `recalib.NAME` or by import."""
    used = set()
    for node in ast.walk(ast.parse(example.read_text(encoding="utf-8"))):
        match node:
            case ast.Attribute(value=ast.Name(id="recalib"), attr=name):
                used.add(name)
            case ast.ImportFrom(module="recalib", names=aliases):
                used.update(alias.name for alias in aliases)
    return used
