"""Descriptions of arms: corrected URDFs, and URDFs from Denavit-Hartenberg parameters."""
