"""Try every assignment of the paper's damage to a robot, and keep the one nearest to the paper."""

from recalib.storage import whole
from recalib.study.assignments import assign
from recalib.study.jobs import Assignments
from workflow.scripts.job import job

with job(snakemake):
    table, assignment = assign(Assignments.model_validate_json(snakemake.params.job))
    with whole(snakemake.output.table) as path:
        table.to_parquet(path, index=False)
    with whole(snakemake.output.assignment) as path:
        assignment.write(path)
