"""Judge every claim of the paper by its criterion."""

import json
from pathlib import Path

import yaml

from recalib.storage import whole
from recalib.study.evidence.claims import judge
from recalib.study.evidence.results import Evidence
from workflow.scripts.job import job

with job(snakemake):
    criteria = yaml.safe_load(Path(snakemake.input.criteria).read_text())
    judged = judge(criteria, Evidence(snakemake.config))
    with whole(snakemake.output[0]) as path:
        path.write_text(json.dumps(judged, indent=2) + "\n")
