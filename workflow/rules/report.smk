"""The report: pages with figures and tables, whose numbers come from the results. `make report` puts them into one file."""

import re


report: "../report/workflow.rst"


PAGES = {
    "Claims of the paper": ["claims"] if EXPERIMENTS["evidence"] else [],
    "Figures": [Path(figure).stem for figure in FIGURES if figure.endswith(".svg")],
    "Tables": ["damages", "errors", "settings", "versions"],
}


def text(page):
    return f"workflow/report/{page}.html"


def title(page):
    """A page's first line. The report sorts by letters: two places for a number bring Figure 2 before Figure 10."""
    heading = (ROOT / text(page)).read_text().splitlines()[0]
    return re.sub(r"(\d+):", lambda number: f"{number[1]:>2}:", heading.removeprefix("<h1>").removesuffix("</h1>"))


rule report_pages:
    input:
        code=code("report_pages.py"),
        texts=[text(page) for page in ["layout", "parts", *sum(PAGES.values(), [])]],
        figures=[figure for figure in FIGURES if figure.endswith(".svg")],
        summary=rules.summary.output[0],
        scenarios=rules.summary.input.scenarios,
        claims=list(rules.claims.output) if EXPERIMENTS["evidence"] else [],
    output:
        [
            report(
                f"{RESULTS}/report/{page}.html",
                caption="../report/page.rst",
                category=category,
                labels={"page": title(page)},
            )
            for category, pages in PAGES.items()
            for page in pages
        ],
    message:
        "Write the pages of the report"
    script:
        "../scripts/report_pages.py"
