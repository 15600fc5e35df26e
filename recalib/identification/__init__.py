"""Identification of the arm from where it went: what today's model-based learners stand on."""
