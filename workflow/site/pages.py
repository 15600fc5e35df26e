"""The site's pages: those of the repository from where they lie, and one from the docstrings."""

from pathlib import Path

from mkdocs.structure.files import File, Files

import recalib
from recalib.study.recording.web_viewer import ADDRESS, embed

SHOWN = (
    "*.md",
    "docs/*.md",
    "figures/*.[psw][nve]*",
    "examples/**/*.py",
    "CITATION.cff",
    "config.yaml",
    "LICENSE",
    "workflow/real/*.toml",
    "workflow/site/**/*.[cj]s*",
    "docs/*.js",
)
PLACES = {"docs/index.md": "index.html", "README.md": "README.html"}  # others keep theirs
WIDE = "docs/index.md", "docs/try.md", "docs/watch.md"  # without columns beside the text
WATCH, VIEWER = "docs/watch.md", "viewer"
# Where the picture is in the repository: the viewer has 35 MB, so nothing is loaded before a click.
EMBEDDED = f"""<button type="button" class="md-button embed" data-address="../{VIEWER}/{ADDRESS}">
Watch the recording here (35 MB)</button>

"""
REFERENCE = """# Reference

What `import recalib` has. [How it fits together](library.md).

"""


def on_files(files: Files, config) -> Files:
    """All that the site has of this project, beside what the theme brings."""
    root = Path(config.config_file_path).parent
    for file in list(files):
        if file.src_dir == config.docs_dir:
            files.remove(file)
    for path in sorted(path for shown in SHOWN for path in root.glob(shown)):
        name = path.relative_to(root).as_posix()
        file = File.generated(config, name, abs_src_path=str(path))
        file.dest_uri = PLACES.get(name, file.dest_uri)
        files.append(file)
    files.append(File.generated(config, "docs/reference.md", content=reference()))
    return files


def on_page_markdown(markdown: str, page, config, files: Files) -> str:
    """Give some pages the whole width, and one the recording, if it was made."""
    if page.file.src_uri in WIDE:
        page.meta["hide"] = ["navigation", "toc"]
    if page.file.src_uri == WATCH and _recording(config).exists():
        return markdown.replace("![", f"{EMBEDDED}![", 1)
    return markdown


def on_post_build(config) -> None:
    """Put the viewer beside the pages, with a recording in it."""
    if _recording(config).exists():
        embed(_recording(config), Path(config.site_dir) / VIEWER)


def _recording(config) -> Path:
    return Path(config.config_file_path).parent / config.extra["recording"]


def reference() -> str:
    """The page of the public names."""
    return REFERENCE + "\n".join(f"::: recalib.{name}\n" for name in recalib.__all__)
