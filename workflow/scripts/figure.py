"""Draw one figure from the evidence."""

from recalib.study.evidence.needs import Needs
from recalib.study.evidence.results import Evidence
from recalib.study.plots.registry import draw
from recalib.study.plots.style import STYLE, plt, save
from workflow.scripts.job import job

with job(snakemake), plt.rc_context(STYLE):
    evidence = Evidence(Needs.model_validate_json(snakemake.params.job))
    save(draw(snakemake.wildcards.figure, evidence), *snakemake.output)
