"""Descriptions of arms: corrected ones, and those from Denavit-Hartenberg parameters."""
