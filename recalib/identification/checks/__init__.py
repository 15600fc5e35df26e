"""Diagnostics: faults in the measurements, and parameters that are not identifiable."""
