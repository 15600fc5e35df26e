"""What measurements say: intervals, and what alternative setups have in common."""
