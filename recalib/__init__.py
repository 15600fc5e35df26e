"""Automatic recalibration of damaged robots: Ruiz de Angulo and Torras (1996), and what came since.

The library knows of arms, damages and learners; `replication` replicates the paper with it. What
a user needs can be imported from here; the examples show how it fits together.
"""

import lazy_loader

__version__ = "2.0.0"

# Pinocchio, Numba and SciPy take a second to import: a name is imported when it is asked for.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
