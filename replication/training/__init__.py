"""Learners on damaged robots: trainings, the search, the benchmark, the real arm."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
