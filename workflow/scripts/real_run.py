"""Let one learner learn from the recorded poses of the real arm."""

from recalib.storage import whole
from recalib.study.experiments.real_arm import learn_from_tables
from recalib.study.jobs import RealRun
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    job_ = RealRun.model_validate_json(snakemake.params.job)
    paths = (snakemake.input[name] for name in ("fit", "test", "description"))
    table = learn_from_tables(job_, *paths)
    table.to_csv(path, index=False)
