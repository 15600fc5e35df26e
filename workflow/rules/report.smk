"""The report: pages of figures and tables. `make report` puts them into one file."""

import re

from replication.pages import report as report_

TEXTS = Path(report_.TEXTS)
PAGES_BY_DEFAULT = ["README.md", "results.md", "choices.md"]
PAGES_OF_THE_SHIPPED = ["findings.md", "deviations.md", "index.md", "study.js"]


report: str(Path(MAIN, "report", f"{report_.FRONT}.rst").resolve())


def read_in(root):
    """The pages of docs/ that a study's report has as well, by the path of their text."""
    pages = report_.READ if STUDIES[root].experiments.evidence else ()
    pages = [page for page in pages if f"{page}.md" in PAGES_BY_DEFAULT or root == RESULTS]
    explained = {report_.EXPLAINED: f"docs/{report_.EXPLAINED}.md"} if root == RESULTS else {}
    return explained | {page: f"{root}/pages/{page}.md" for page in pages}


def kept_in(root):
    """Those that are committed, with their figures: no inputs, since other targets write them."""
    return report_.KEPT if root == RESULTS else {}


def other_pages_of(root):
    """All of them by name."""
    return [*read_in(root), *kept_in(root)]


def pages_of(root):
    """The pages of a study's report, by category."""
    return {
        "Claims of the paper": ["claims"] if judging(request(root)) else [],
        "Figures": drawn(STUDIES[root], request(root)),
        "Method, findings, guidance": other_pages_of(root),
        "Tables": list(report_.TABLES),
    }


def title(page):
    """A page's heading. The report sorts by letters: Figure 2 comes before Figure 10 so padded."""
    return re.sub(r"(\d+):", lambda number: f"{number[1]:>2}:", report_.heading(page, ROOT))


def page_in_report(root, page, category):
    """A page as an output."""
    path, labels = f"{root}/report/{page}.html", {"page": title(page)}
    return report(path, caption="../report/page.rst", category=category, labels=labels)


def report_of(root):
    """The pages of a study's report."""
    return [f"{root}/report/{page}.html" for pages in pages_of(root).values() for page in pages]


def pictures_of(root):
    """The pictures of ideas that show no result: figures/ideas.py draws them."""
    names = "method", "fake_pose", "increments", "schedule"
    return [f"figures/{name}.svg" for name in names] if root == RESULTS else []


def read_by_report(root):
    """Texts, pages and evidence."""
    texts = [*sorted(TEXTS.iterdir()), *pictures_of(root), *read_in(root).values()]
    both = [(f"docs/{page}.md", f"figures/{figure}.svg") for page, figure in kept_in(root).items()]
    return [*texts, *asked(root, report_.NEEDS).inputs, *sum(both, ())]


# How many pages there are is known of each study by itself, hence a rule for each.
for root_ in STUDIES:
    own_ = {*sum(pages_of(root_).values(), [])} - {*other_pages_of(root_)}
    texts_ = ["layout", "parts", *sorted(own_)]
    ideas_ = [f"{root_}/figures/{name}.svg" for name in ideas_of(root_)]

    rule:
        name:
            f"report_pages_{STUDIES[root_].name}"
        input:
            texts=[
                *(TEXTS / f"{name}.html" for name in texts_),
                TEXTS / f"{report_.FRONT}.rst",
            ],
            read=list(read_in(root_).values()),
            figures=[
                *(path for path in figures_of(root_) if path.endswith(".svg")),
                *ideas_,
                *pictures_of(root_),
            ],
            files=asked(root_, report_.NEEDS).inputs,
        output:
            pages=[
                page_in_report(root_, page, category)
                for category, pages in pages_of(root_).items()
                for page in pages
            ],
            rst=f"{root_}/report/{report_.FRONT}.rst",
        log:
            f"{root_}/logs/report_pages.log",
        localrule: True
        params:
            **calls(
                "replication.pages.report.write",
                reads=lambda w, root=root_: read_by_report(root),
            ),
            arguments=lambda w, root=root_: as_text(evidence=asked(root, report_.NEEDS)),
        message:
            "Write the pages of the report"
        script:
            "../scripts/call.py"
