"""Measure one replicate of the reference study."""

from recalib.storage import whole
from recalib.study.configuration.study import Study
from recalib.study.multiverse.reference import reference, reference_universe
from recalib.study.plants import Resolved
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    import pandas as pd  # a quarter of a second: no start waits for it

    study = Study.model_validate_json(snakemake.params.study)
    setup = reference_universe(study, Resolved.read(snakemake.input.scenario))
    row = reference(setup, int(snakemake.wildcards.number))
    pd.DataFrame([row]).to_csv(path, index=False, float_format="%.6g")
