"""Learners on damaged robots: trainings, the search, the benchmark, the real arm."""
