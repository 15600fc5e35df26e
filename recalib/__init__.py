"""Automatic recalibration of damaged robots: Ruiz de Angulo and Torras (1996), and what came since.

The library knows of arms, damages and learners; `recalib.study` replicates the paper with it. What
a reader needs first can be imported from here; the examples show how it fits together.
"""

from importlib import import_module

__version__ = "0.2.0"

# Where each name is at home. It is imported when it is asked for: Pinocchio, SciPy and scikit-learn
# take seconds, and nobody needs all of them.
_HOMES = {
    "Controller": "recalib.nominal.controller",
    "ExternalRobot": "recalib.external",
    "GeometricLearner": "recalib.learners.geometric",
    "HierarchicalLearner": "recalib.learners.hierarchical",
    "IMPROVED": "recalib.learners.rules",
    "Observations": "recalib.identification.observations",
    "Plant": "recalib.damaged.plant",
    "Schedule": "recalib.learners.schedules",
    "Workspace": "recalib.nominal.poses",
    "calibrate": "recalib.identification.calibration",
    "guess_frames": "recalib.identification.first_guess",
    "load": "recalib.loading",
    "load_robot": "recalib.nominal.robots",
    "save": "recalib.learned",
    "train": "recalib.training",
}
__all__ = [*_HOMES]


def __getattr__(name: str):
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return [*globals(), *_HOMES]
