"""Checks of a study that types cannot express: of its trainings, claims and robots."""
