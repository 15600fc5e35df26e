"""Which answers can be believed: faults in the rows, and what no measurement told."""
