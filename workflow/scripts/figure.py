"""Draw one figure from the evidence."""

from recalib.study import plots
from recalib.study.evidence.results import Evidence
from workflow.scripts.job import job

with job(snakemake), plots.plt.rc_context(plots.STYLE):
    figure = plots.FIGURES[snakemake.wildcards.figure](Evidence(snakemake.config))
    plots.save(figure, snakemake.output.svg, snakemake.output.png)
