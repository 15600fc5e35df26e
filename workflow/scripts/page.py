"""Render one page from its template."""

from recalib.storage import whole
from recalib.study.evidence.needs import Needs
from recalib.study.evidence.pages import PAGES, render
from recalib.study.evidence.results import Evidence
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    evidence = Evidence(Needs.model_validate_json(snakemake.params.job))
    known = PAGES[snakemake.wildcards.page].context(evidence)
    path.write_text(render(snakemake.input.template, known), encoding="utf-8")
