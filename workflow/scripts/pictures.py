"""Take pictures of the arm before and after its recalibration, with the real viewer."""

from pathlib import Path

from recalib.study.recording.phases import AFTER, BEFORE
from recalib.study.recording.pictures import take_pictures
from workflow.scripts.job import job

with job(snakemake):
    before, after = map(Path, snakemake.output)
    take_pictures(Path(snakemake.input.recording), {before: BEFORE, after: AFTER})
