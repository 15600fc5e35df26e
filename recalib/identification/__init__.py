"""Identification of an arm from measurements: the basis of today's model-based learners."""
