"""Which answers can be trusted: faults in the rows, and what no measurement told."""
