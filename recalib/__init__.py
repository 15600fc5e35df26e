"""Automatic recalibration of damaged robots: Ruiz de Angulo and Torras (1996), and newer methods.

The library contains arms, damages and learners; `replication` uses it to replicate the paper. All
public names can be imported from here; the examples show how they fit together.
"""

import lazy_loader

__version__ = "2.0.0"

# Pinocchio, Numba and SciPy take a second to import, so each name is imported at its first use.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
