"""The script of the workflow."""
