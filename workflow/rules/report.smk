"""The report: pages of figures and tables. `make report` puts them into one file."""

import re

from recalib.study.evidence import report as report_

TEXTS = Path(report_.TEXTS)


report: str(Path(Layout(MAIN).report_page(report_.FRONT, ".rst")).resolve())


def pages_of(root):
    """The pages of a study's report, by category."""
    return {
        "Claims of the paper": ["claims"] if STUDIES[root].experiments.evidence else [],
        "Figures": drawn(STUDIES[root], request(root)),
        "Tables": list(report_.TABLES),
    }


def title(page):
    """A page's heading. The report sorts by letters: Figure 2 comes before Figure 10 so padded."""
    return re.sub(r"(\d+):", lambda number: f"{number[1]:>2}:", report_.heading(page, ROOT))


def page_in_report(root, page, category):
    """A page as an output."""
    path = Layout(root).report_page(page)
    return report(path, caption="../report/page.rst", category=category, labels={"page": title(page)})


def report_of(root):
    """The pages of a study's report."""
    return [Layout(root).report_page(page) for pages in pages_of(root).values() for page in pages]


# How many pages there are is known of each study by itself, hence a rule for each.
for root_ in STUDIES:
    texts_ = ["layout", "parts", *sum(pages_of(root_).values(), [])]

    rule:
        name:
            f"report_pages_{STUDIES[root_].name}"
        input:
            texts=[*(TEXTS / f"{name}.html" for name in texts_), TEXTS / f"{report_.FRONT}.rst"],
            figures=[path for path in figures_of(root_) if path.endswith(".svg")],
            evidence=asked(root_, report_.needs).inputs,
        output:
            pages=[
                page_in_report(root_, page, category)
                for category, pages in pages_of(root_).items()
                for page in pages
            ],
            front=Layout(root_).report_page(report_.FRONT, ".rst"),
        params:
            code=code("report_pages.py"),
            job=lambda w, root=root_: as_text(asked(root, report_.needs)),
        localrule: True
        message:
            "Write the pages of the report"
        script:
            "../scripts/report_pages.py"
