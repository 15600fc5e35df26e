"""Support for the workflow's rules and jobs: reading and checking studies, writing outputs."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
