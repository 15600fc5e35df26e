"""What the workflow's rules and jobs need: studies of a call, what jobs find around them."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
