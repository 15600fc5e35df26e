"""Recordings of an arm before, during and after recalibration. Only this package imports Rerun."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
