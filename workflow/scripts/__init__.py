"""Scripts of the workflow: each unpacks `snakemake`, calls recalib and writes whole files."""
