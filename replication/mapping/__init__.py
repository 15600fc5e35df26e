"""Measurements for the paper's claims about the mapping and the cells, mostly without training."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
