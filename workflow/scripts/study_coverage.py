"""Do the intervals hold? Repeat the study in small, within itself."""

from recalib.storage import whole
from recalib.study.evidence.coverage import coverage
from recalib.study.evidence.needs import Needs
from recalib.study.evidence.results import Evidence
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    table = coverage(Evidence(Needs.model_validate_json(snakemake.params.job)))
    table.to_csv(path, index=False, float_format="%.4g")
