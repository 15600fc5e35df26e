"""Resolve a scenario's damages on its robot, and measure the initial errors."""

from recalib.storage import whole
from recalib.study.assignments import Assignment
from recalib.study.jobs import Scenario
from recalib.study.plants import resolve
from workflow.scripts.job import job

with job(snakemake):
    assigned = [Assignment.read(path).damages for path in snakemake.input.assignment]
    resolved = resolve(Scenario.model_validate_json(snakemake.params.job), *assigned)
    with whole(snakemake.output[0]) as path:
        resolved.write(path)
