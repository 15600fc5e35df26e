"""Faults that befall a run, tried one after the other: `python -m tests.faults`."""
