"""Render README and findings."""

from pathlib import Path

from recalib.storage import whole
from recalib.study.evidence.pages import context, render
from recalib.study.evidence.results import Evidence
from workflow.scripts.job import job

with job(snakemake):
    pictures = all(
        (Path(snakemake.config["figures"]) / f"arm_{when}.png").exists()
        for when in ("before", "after")
    )
    known = context(Evidence(snakemake.config), pictures)
    for template, page in zip(snakemake.input.templates, snakemake.output, strict=True):
        with whole(page) as path:
            path.write_text(render(template, known))
