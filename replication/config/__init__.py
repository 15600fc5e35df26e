"""The configuration of a study: keys with meaning, unit and range; reading and checking it."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
