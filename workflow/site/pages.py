"""The site's pages: those of the repository from where they lie, and one from the docstrings."""

from pathlib import Path

from mkdocs.structure.files import File, Files

import recalib

SHOWN = (
    "*.md",
    "docs/*.md",
    "figures/*.[psw][nve]*",
    "examples/*.py",
    "CITATION.cff",
    "config.yaml",
    "LICENSE",
    "workflow/real/*.toml",
    "workflow/site/**/*.[cj]s*",
    "docs/*.js",
)
PLACES = {"docs/index.md": "index.html", "README.md": "README.html"}  # others keep theirs
WIDE = "docs/index.md", "docs/try.md"  # without columns beside the text
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


def on_page_markdown(markdown: str, page, config, files: Files) -> None:
    """Give some pages the whole width."""
    if page.file.src_uri in WIDE:
        page.meta["hide"] = ["navigation", "toc"]


def reference() -> str:
    """The page of the public names."""
    return REFERENCE + "\n".join(f"::: recalib.{name}\n" for name in recalib.__all__)
