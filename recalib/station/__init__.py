"""Arms that move and measure by themselves: a calibration that goes on while it is watched."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
