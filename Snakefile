"""Automatic recalibration of a space robot (1996), replicated: `snakemake --cores 2` does it all."""

from snakemake.utils import min_version

min_version("9.0")


include: "workflow/rules/common.smk"
include: "workflow/rules/scenarios.smk"
include: "workflow/rules/search.smk"
include: "workflow/rules/experiments.smk"
include: "workflow/rules/mapping.smk"
include: "workflow/rules/evidence.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/recordings.smk"
include: "workflow/rules/report.smk"
include: "workflow/rules/check.smk"
include: "workflow/rules/benchmark.smk"
include: "workflow/rules/studies.smk"
include: "workflow/rules/universes.smk"


rule all:
    default_target: True
    input:
        lambda w: everything(MAIN),
    message:
        "All results are there"
