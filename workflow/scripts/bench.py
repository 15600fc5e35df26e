"""How fast are moves and trainings?"""

from recalib.storage import whole
from recalib.study.experiments.speed import measure_speed
from recalib.study.jobs import Speed
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    job_ = Speed.model_validate_json(snakemake.params.job)
    samples = dict(zip(job_.learners, snakemake.input.samples, strict=True))
    lines = measure_speed(job_, snakemake.input.scenario, samples)
    path.write_text(lines, encoding="utf-8")
    print(lines)
