"""Which answers can be trusted: faults in the rows, and what is not identifiable."""
