"""Evidence: results of all trainings, the verdicts and checks on them, and pages that say so."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
