"""What pages and figures say of the universes: made-up ones, beside made-up results."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from recalib.study.evidence.claims import CLAIMS
from recalib.study.evidence.pages import PAGES, render
from recalib.study.evidence.results import Evidence
from recalib.study.layout import DESIGN, OUTCOMES
from recalib.study.plots.registry import FIGURES, draw, drawn
from recalib.study.plots.style import STYLE, plt
from recalib.study.studies import SHIPPED
from tests.conftest import ROOT
from tests.made_up import MadeUp

COLUMNS = {across.column for claim in CLAIMS for across in claim.across.values()}
BEYOND = 40  # of the universes Ritter's does not get there


@pytest.fixture(scope="module")
def outcomes() -> pd.DataFrame:
    random, count = np.random.default_rng(0), len(pd.read_csv(ROOT / DESIGN))
    columns = {name: random.lognormal(0, 0.5, count) for name in sorted(COLUMNS)}
    columns["factor"] = np.where(np.arange(count) < BEYOND, np.inf, 30 * columns["factor"])
    return pd.DataFrame({"universe": range(count)} | columns)


@pytest.fixture(scope="module")
def made_up(few, outcomes, tmp_path_factory) -> MadeUp:
    """Results of the shipped study, where the project has universes."""
    folder = tmp_path_factory.mktemp("multiverse")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        Path(DESIGN).parent.mkdir(parents=True)
        shutil.copy(ROOT / DESIGN, DESIGN)
        outcomes.to_csv(OUTCOMES, index=False)
        its = MadeUp(Path(), few.model_copy(update={"name": SHIPPED}))
        its.conclude()
        yield its


def page(name: str, made_up: MadeUp) -> str:
    context = PAGES[name].context(Evidence(made_up.needs(PAGES[name].needs)))
    return render(ROOT / "workflow" / "templates" / f"{name}.j2", context)


def test_the_pages_say_in_how_many_universes_each_claim_holds(made_up, outcomes):
    holds = f"{int((outcomes['left'] < 0.1).sum())} of {len(outcomes)}"
    assert f" *{holds}.*\n" in page("README.md", made_up)
    text = page("results.md", made_up)
    assert f"| {holds} |" in text and "| cannot vary |" in text
    assert f"({len(outcomes)} of them, drawn before the first was run)" in text


def test_the_findings_tell_the_factor_over_all_universes(made_up, outcomes):
    text = " ".join(page("findings.md", made_up).split())
    half = outcomes["factor"].quantile(0.5, interpolation="lower")
    assert f"50 % of them are below {half:.0f}. In {BEYOND}" in text, "three quarters are not known"
    assert f"In {BEYOND} of {len(outcomes)} Ritter's map needs more than 10,000" in text


@pytest.mark.parametrize("name", ["figure14", "figure15"])
def test_figures_of_the_multiverse_have_a_panel_for_each_claim_and_system(made_up, outcomes, name):
    with plt.rc_context(STYLE):
        figure = draw(name, Evidence(made_up.needs(FIGURES[name].needs)))
    titles = [axes.get_title(loc="left") + axes.get_title(loc="right") for axes in figure.axes]
    assert len(titles) == sum(len(claim.across) for claim in CLAIMS)
    if name == "figure14":
        holds = int((outcomes["maps_ritter"] < 1).sum())
        of_maps = next(claim.short.split(":")[0] for claim in CLAIMS if claim.id == "separate-maps")
        expected = f"{of_maps} Ritter's: below 1 in {holds} of {len(outcomes)}"
        assert expected in [" ".join(each.split()) for each in titles]
    plt.close(figure)


def test_a_study_that_is_not_the_shipped_one_has_no_universes(made_up):
    other = MadeUp(Path("other"), made_up.study.model_copy(update={"name": "other"}))
    assert not {"figure14", "figure15"} & {*drawn(other.study, other.request)}
    assert {"figure14", "figure15"} <= {*drawn(made_up.study, made_up.request)}
