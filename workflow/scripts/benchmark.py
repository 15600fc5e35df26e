"""Let one learner work through scenarios of the benchmark."""

from recalib.storage import whole
from recalib.study.experiments.benchmark import compete
from recalib.study.jobs import Benchmark
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    job_, samples = Benchmark.model_validate_json(snakemake.params.job), snakemake.input.samples
    compete(job_, snakemake.input.scenarios, *samples).to_parquet(path, index=False)
