"""The maps of 1996 choose their poses, so they learn on a twin of the real arm."""

from recalib.storage import whole
from recalib.study.experiments.real_arm import learn_on_twin
from recalib.study.jobs import RealTwin
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    job_ = RealTwin.model_validate_json(snakemake.params.job)
    paths = (snakemake.input[name] for name in ("fit", "description", "sample"))
    learn_on_twin(job_, *paths).to_csv(path, index=False)
