"""Error models: the errors of an arm as parameters, and the residuals of measurements."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
