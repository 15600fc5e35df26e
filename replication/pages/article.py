"""The article as a PDF."""

from pathlib import Path

import matplotlib
import typst

from recalib.files.storage import whole


def typeset(source: Path, article: Path, project: Path = Path()) -> None:
    """Write the article as a PDF, tagged for screen readers, with only the fonts of its figures.

    `source` is in Typst; its paths are relative to the project's folder.

    Raises typst.TypstError for a reference, a figure or a symbol that Typst does not know.
    """
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
