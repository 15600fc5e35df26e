"""The configuration of a study: its keys with meaning, unit and range, its reading and checking."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
