"""Automatic recalibration of a space robot (1996), replicated: `snakemake --cores 2` does everything."""

from snakemake.utils import min_version

min_version("9.0")


configfile: "config.yaml"


include: "workflow/rules/common.smk"
include: "workflow/rules/scenarios.smk"
include: "workflow/rules/experiments.smk"
include: "workflow/rules/search.smk"
include: "workflow/rules/evidence.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/recordings.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/check.smk"
include: "workflow/rules/benchmark.smk"


rule all:
    default_target: True
    input:
        rules.check.output,
        rules.summary.output,
        [*rules.claims.output, *rules.pages.output] if EXPERIMENTS["evidence"] else [],
        FIGURES,
        RECORDINGS,
        rules.report_pages.output,
    message:
        "All results are there"
