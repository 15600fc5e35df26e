"""The Snakemake workflow of the replication."""
