"""Faults that befall runs, commands and their files, tried one after the other: `make faults`."""
