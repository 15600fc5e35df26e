"""How each figure is drawn: evidence in, a drawing out."""

from recalib.study.plots.benchmark import figure12, figure13
from recalib.study.plots.changes import figure4
from recalib.study.plots.elsewhere import figure11
from recalib.study.plots.explained.fake_pose import fake_pose
from recalib.study.plots.explained.increments import increments
from recalib.study.plots.explained.method import method
from recalib.study.plots.explained.multiverse import multiverse
from recalib.study.plots.explained.schedule import schedule
from recalib.study.plots.ladders import figure9
from recalib.study.plots.learning import figure1, figure2, figure3
from recalib.study.plots.mapping import figure5, figure7, figure8, figure10
from recalib.study.plots.searched import figure6
from recalib.study.plots.universes import figure14, figure15

DRAWINGS = {
    "figure1": figure1,
    "figure2": figure2,
    "figure3": figure3,
    "figure4": figure4,
    "figure5": figure5,
    "figure6": figure6,
    "figure7": figure7,
    "figure8": figure8,
    "figure9": figure9,
    "figure10": figure10,
    "figure11": figure11,
    "figure12": figure12,
    "figure13": figure13,
    "figure14": figure14,
    "figure15": figure15,
    "method": method,
    "fake_pose": fake_pose,
    "increments": increments,
    "schedule": schedule,
    "multiverse": multiverse,
}
