"""Film the arm as it misses, learns and hits, with the real viewer."""

from pathlib import Path

from recalib.study.recording.pictures import take_film
from workflow.scripts.job import job

with job(snakemake):
    take_film(Path(snakemake.input.recording), Path(snakemake.output[0]))
