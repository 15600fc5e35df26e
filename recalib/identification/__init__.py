"""Identification of an arm from measurements: the basis of today's model-based learners."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
