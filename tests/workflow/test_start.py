"""What comes with a job's start: of what is heavy, each package takes a tenth of a second or more.

None is too much to use, but a job waits for what its script imports, whether it needs it or not.
"""

import ast

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
STARTS = {
    "claims concat gather outcome page power report_pages": set(),
    "benchmark_table check expect piece real_table search_sample study_visits summarise": {
        "pandas"
    },
    "assign bench benchmark design ensemble real_run real_twin scenario search": ARMS,
    "study_mapping study_replay train universe efforts": ARMS - {"scipy.spatial"},
    "horizon reference": ARMS - {"scipy.spatial"},
    "real_data": ARMS - {"numba"},
    "figure": {"matplotlib"},
    "film pictures": {"rerun"},
    "record": ARMS | {"pandas", "rerun"},
}
SCRIPTS = ROOT / "workflow" / "scripts"
EXPLAINED = [its.home for its in FIGURES.values() if its.part == "ideas"]


def imports_of(script: str) -> str:
    nodes = ast.parse((SCRIPTS / f"{script}.py").read_text(encoding="utf-8")).body
    imports = [each for each in nodes if isinstance(each, ast.Import | ast.ImportFrom)]
    return "; ".join(map(ast.unparse, imports))


def test_every_script_has_a_start():
    scripts = {path.stem for path in SCRIPTS.glob("*.py")} - {"__init__", "job"}
    assert scripts == set(" ".join(STARTS).split())


@pytest.mark.parametrize("scripts", STARTS)
def test_a_job_starts_with_what_it_needs(scripts):
    imports = "; ".join(map(imports_of, scripts.split()))
    assert loaded_with(imports, HEAVY) == STARTS[scripts]


def test_a_figure_of_results_moves_no_arm():
    """Those of ideas are drawn with the method's own code."""
    homes = {its.home for its in FIGURES.values()} - {*EXPLAINED}
    assert loaded_with(f"import {', '.join(sorted(homes))}", HEAVY) == {"matplotlib", "pandas"}
