"""Measurements of the paper's arguments that need no training: what it says of the mapping, not of the learner."""
