"""Calibration of a real arm: tables and a URDF in, a calibration and its files out."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
