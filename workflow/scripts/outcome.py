"""Say what came out of a study."""

from recalib.storage import whole
from recalib.study.evidence.needs import Needs
from recalib.study.evidence.outcome import outcome
from recalib.study.evidence.results import Evidence
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    evidence = Evidence(Needs.model_validate_json(snakemake.params.job))
    path.write_text(outcome(evidence), encoding="utf-8")
