"""Draw the universes of the multiverse, and find out where their robots can work."""

from recalib.storage import whole
from recalib.study.jobs import Design
from recalib.study.multiverse.design import write_design
from recalib.study.multiverse.drawing import draw_design
from workflow.scripts.job import job

with job(snakemake):
    universes = draw_design(Design.model_validate_json(snakemake.params.job))
    with whole(snakemake.output[0]) as path:
        write_design(path, universes)
