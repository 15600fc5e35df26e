"""Faults that befall a run, tried one after the other: `make faults`."""
