"""Judge every claim of the paper by its criterion."""

import json

from recalib.storage import whole
from recalib.study.evidence.claims import Judging, judge
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    judged = judge(Judging.model_validate_json(snakemake.params.job))
    path.write_text(json.dumps(judged, indent=2) + "\n", encoding="utf-8")
