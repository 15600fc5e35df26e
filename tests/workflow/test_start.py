"""What comes with a job's start: of what is heavy, each package takes a tenth of a second or more.

None is too much to use, but a job waits for what its function's module imports, needed or not.
"""

import re

import pytest

from recalib.study.plots.registry import FIGURES
from tests.conftest import ROOT, loaded_with

HEAVY = {
    "jinja2",
    "matplotlib",
    "numba",
    "pandas",
    "pinocchio",
    "rerun",
    "scipy.optimize",
    "scipy.spatial",
    "scipy.stats",
    "sklearn",
    "snakemake",
}
ARMS = {"numba", "pinocchio", "scipy.spatial"}
# Modules of recalib.study, by what they bring.
STARTS = {
    "evidence.article evidence.claims evidence.outcome evidence.pages evidence.real"
    " evidence.report"
    " experiments.joining experiments.samples multiverse.design multiverse.power"
    " plots.registry": set(),
    "evidence.benchmark evidence.checks evidence.summary mapping.visits": {"pandas"},
    "assignments experiments.benchmark experiments.ensemble experiments.real_arm"
    " experiments.speed experiments.trials multiverse.drawing plants": ARMS,
    "experiments.campaign experiments.replay mapping.measured multiverse.efforts"
    " multiverse.horizon multiverse.measuring multiverse.reference": ARMS - {"scipy.spatial"},
    "experiments.tracker": ARMS - {"numba"},
    "recording.pictures": {"rerun"},
    "recording.writing": ARMS | {"pandas", "rerun"},
}
EXPLAINED = [its.home for its in FIGURES.values() if its.part == "ideas"]


def called() -> set[str]:
    """The modules of the functions that rules call."""
    texts = (path.read_text(encoding="utf-8") for path in (ROOT / "workflow/rules").glob("*.smk"))
    names = re.findall(r'calls\(\s*"recalib\.study\.([\w.]+)\.\w+"', "".join(texts))
    return {*names}


def test_every_function_has_a_start():
    assert called() == {*" ".join(STARTS).split()}


@pytest.mark.parametrize("modules", STARTS)
def test_a_job_starts_with_what_it_needs(modules):
    names = (f"recalib.study.{name}" for name in modules.split())
    assert (
        loaded_with(f"import workflow.scripts.call, {', '.join(names)}", HEAVY) == STARTS[modules]
    )


def test_a_figure_of_results_moves_no_arm():
    """Those of ideas are drawn with the method's own code."""
    homes = {its.home for its in FIGURES.values()} - {*EXPLAINED}
    assert loaded_with(f"import {', '.join(sorted(homes))}", HEAVY) == {"matplotlib", "pandas"}
