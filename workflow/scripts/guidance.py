"""Render the page of guidance."""

from recalib.storage import whole
from recalib.study.evidence.guidance import context
from recalib.study.evidence.pages import render
from recalib.study.evidence.results import Evidence
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    path.write_text(render(snakemake.input.template, context(Evidence(snakemake.config))))
