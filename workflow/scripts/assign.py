"""Try every assignment of the paper's damage to a robot, and keep the one nearest to the paper."""

import pyarrow as pa
import pyarrow.parquet as pq

from recalib.storage import whole
from recalib.study.assignments import assign
from recalib.study.jobs import Assignments
from workflow.scripts.job import job

with job(snakemake):
    table, assignment = assign(Assignments.model_validate_json(snakemake.params.job))
    with whole(snakemake.output.table) as path:
        pq.write_table(pa.table(table), path)
    with whole(snakemake.output.assignment) as path:
        assignment.write(path)
