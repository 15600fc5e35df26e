"""Learners on damaged robots: trainings, the search, the benchmark, the real arm.

Wherever a function asks for them, `scenario` is the file of a scenario as resolved, `sample` that
of the searches for a training, and `seed` the study's.
"""
