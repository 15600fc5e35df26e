"""A damage on a robot: which links and encoders, and the plant that it makes."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
