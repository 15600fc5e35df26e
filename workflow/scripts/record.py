"""Record the arm of a scenario before, during and after its recalibration."""

from recalib.study.jobs import Recording
from recalib.study.recording.writing import record
from workflow.scripts.job import job

with job(snakemake):
    record(
        snakemake.output[0],
        Recording.model_validate_json(snakemake.params.job),
        snakemake.input.scenario,
        snakemake.input.samples,
        snakemake.input.histories,
    )
