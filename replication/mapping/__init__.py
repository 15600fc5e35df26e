"""What the paper says of the mapping and of the cells, before it trains a learner."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
