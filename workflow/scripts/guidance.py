"""Render the page of guidance."""

from recalib.evidence.guidance import context
from recalib.evidence.pages import render
from recalib.evidence.results import Evidence
from recalib.storage import whole
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    path.write_text(render(snakemake.input.template, context(Evidence(snakemake.config))))
