"""Do some of the searches for one training."""

from recalib.storage import whole
from recalib.study.experiments.trials import search_for
from recalib.study.jobs import Searches
from workflow.scripts.job import job

with job(snakemake), whole(snakemake.output[0]) as path:
    searches = Searches.model_validate_json(snakemake.params.job)
    search_for(searches, snakemake.input.scenario).to_csv(path, index=False)
