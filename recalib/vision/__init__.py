"""Pictures of a board: the board, the lens, and the detection of corners."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
