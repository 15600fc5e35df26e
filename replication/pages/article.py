"""The article as a PDF."""

from pathlib import Path

import matplotlib
import typst

from recalib.files.storage import whole


def typeset(source: Path, article: Path, project: Path = Path()) -> None:
    """Write the article as a PDF, tagged for screen readers, with the fonts of its figures alone.

    Its `source` is in Typst; paths in there begin at the project's folder.

    Raises typst.TypstError: a reference, a figure or a sign that Typst does not know.
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
