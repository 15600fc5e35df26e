"""The page of guidance and that of the real arm, from small tables."""

import pandas as pd
import pytest

from replication.pages import Contents, render
from replication.training import BOTH

ERRORS = {  # of position [cm] after 4 and 8 moves
    "geometric": (0.10, 0.05),
    "hybrid": (0.10, 0.06),
    "improved": (4.0, 0.01),
}


def benchmark(study) -> tuple[pd.DataFrame, pd.DataFrame]:
    """One scenario, in which the hybrid is 20 % worse than geometry after 8 moves."""
    errors = pd.DataFrame(
        [
            {"scenario": "links_encoders", "learner": learner, "moves": moves, "seeds": 20}
            | {"position_error_cm": error, "orientation_error_deg": 0.1}
            for learner, both in ERRORS.items()
            for moves, error in zip((4, 8), both, strict=True)
        ]
    )
    moves = {"geometric": (3, 2, 6), "hybrid": (3, 3, 3), "improved": (float("inf"),) * 3}
    reached = pd.DataFrame(
        [
            {"scenario": "links_encoders", "learner": learner, "error": BOTH}
            | {"threshold": min(study.benchmark.thresholds)}
            | dict(zip(("moves", "low", "high"), its, strict=True))
            for learner, its in moves.items()
        ]
    )
    return errors, reached


@pytest.fixture
def contents(study, project) -> Contents:
    folder = project(study, 0)
    errors, reached = benchmark(study)
    errors.to_csv(folder / "results" / "benchmark.csv", index=False)
    reached.to_csv(folder / "results" / "benchmark_moves.csv", index=False)
    real = pd.DataFrame(
        [
            ("geometric", False, 10, 0.1624),
            ("improved", True, 10, 1.286),
            ("improved", True, 400, 0.2),
        ],
        columns=["learner", "twin", "poses", "position_error_mm"],
    )
    real.to_csv(folder / "results" / "real.csv", index=False)
    return Contents(study, (), folder)


def test_moves_have_their_quantiles_if_these_differ(contents):
    page = render("guidance.md", contents)
    assert "| scenario | geometric | hybrid | improved |" in page
    assert "| links encoders | 3 (2 to 6) | 3 | - |" in page


def test_the_hybrid_is_compared_with_other_learners_of_today(contents):
    page = render("guidance.md", contents)
    assert (
        "other learner's in 1 comparisons, at most by a\nfactor of 1.2: in the scenario links"
        in page
    )
    (row,) = contents.benchmark.worse
    assert row.moves == 8
    assert row.ratio == pytest.approx(1.2), "over geometry; improved is of 1996"


def test_a_learner_on_the_twin_has_a_row_of_its_own_and_its_last_error(contents):
    page = render("real_arm.md", contents)
    assert "| geometric | - | 0.162 | - |" in page
    assert "| improved on a twin | - | 1.286 | - |" in page
    assert "At the end of its 400 moves, *improved* has an error of 0.200 mm." in page
