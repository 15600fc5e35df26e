"""Replication of "Automatic recalibration of a space robot" (1996): run `snakemake --cores 2`."""

from snakemake.utils import min_version

min_version("9.0")


include: "workflow/rules/common.smk"
include: "workflow/rules/campaign.smk"
include: "workflow/rules/trainings.smk"
include: "workflow/rules/judgement.smk"
include: "workflow/rules/benchmark.smk"
include: "workflow/rules/publication.smk"


rule all:
    default_target: True
    input:
        EVERYTHING,
    message:
        "All results are complete"
