"""Learners let loose on damaged robots: trainings, the search for their settings, the benchmark, the real arm."""
