"""Write the pages of the report: texts with the numbers, figures and tables of the results."""

from pathlib import Path

from recalib.storage import whole
from recalib.study.evidence.needs import Needs
from recalib.study.evidence.report import context, front, page
from recalib.study.evidence.results import Evidence
from workflow.scripts.job import job

with job(snakemake):
    known = context(Evidence(Needs.model_validate_json(snakemake.params.job)))
    figures = {Path(path).stem: path for path in snakemake.input.figures}
    for output in map(Path, snakemake.output.pages):
        with whole(output) as path:
            path.write_text(page(output.stem, known, figures), encoding="utf-8")
    with whole(snakemake.output.front) as path:
        path.write_text(front(known, figures), encoding="utf-8")
