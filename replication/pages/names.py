"""The names of a study's pages, in a module without the imports that writing needs."""

from replication.config.shipped import SHIPPED
from replication.config.study import Study

OUTCOME = "outcome.txt"  # a run prints this page when it ends
EVERYWHERE = (OUTCOME, "findings.md")
OF_SHIPPED = ("README.md", "index.md", "choices.md", "deviations.md", "article.typ")


def pages_of(study: Study) -> list[str]:
    """The pages that a run of a study writes."""
    return [*EVERYWHERE, *(OF_SHIPPED if study.name == SHIPPED else ())]
