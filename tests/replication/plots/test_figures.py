"""Figures show the numbers of the tables; the same tables give the same files."""

import runpy

import matplotlib.pyplot as plt
import numpy as np
import pytest

from replication.campaign import DOUBLE
from replication.config import IMPROVED, RITTER
from replication.judgement import Crossing, Evidence, Remaining
from replication.judgement.claims import claims
from replication.plots import APART, BOTH, LABELS, Figure, figures_of, rendering, rows
from replication.training import leading
from tests.conftest import ROOT, changed
from tests.replication.plots.conftest import NEEDED


def files(folder):
    return [folder / f"{figure.file}.{suffix}" for figure in Figure for suffix in ("svg", "png")]


@pytest.mark.slow  # all figures are drawn twice, to SVG and PNG
def test_equal_results_give_equal_bytes(small, project, tmp_path, monkeypatch):
    monkeypatch.chdir(project())
    drawn = []
    for number in range(2):
        paths = files(tmp_path / str(number))
        paths[0].parent.mkdir()
        rendering.draw(small, paths)
        drawn.append({path.name: path.read_bytes() for path in paths})
    assert drawn[0] == drawn[1]
    assert min(map(len, drawn[0].values())) > 5000, "no figure is empty"


def test_the_committed_pictures_of_ideas_are_those_that_their_code_draws(tmp_path):
    runpy.run_path(str(ROOT / "figures" / "ideas.py"))["draw"](tmp_path)
    drawings = sorted(tmp_path.iterdir())
    assert len(drawings) == 8
    for path in drawings:
        assert path.read_bytes() == (ROOT / "figures" / path.name).read_bytes(), path.name


def curve(axes, label):
    (found,) = [line for line in axes.lines if line.get_label() == label]
    return found.get_data()


def test_figure_1_shows_the_means_of_the_seeds(figures, evidence):
    history = evidence.history(*leading(evidence.study))
    for axes in figures[Figure.FIGURE_1].axes:
        for error in BOTH:
            iterations, errors = curve(axes, error.kind)
            means = history.groupby("iteration")[error.column].mean()
            assert iterations[-1] == 200 and np.allclose(errors, means)
    (legend,) = figures[Figure.LEARNERS].legends
    labels = [text.get_text() for text in legend.get_texts()]
    trained = "improved, 200", "Ritter, 200", "Ritter, 10,000"
    assert labels == [f"{name} iterations" for name in trained]
    _, errors = curve(figures[Figure.LEARNERS].axes[0], labels[0])
    assert errors[-1] == pytest.approx(evidence.errors(IMPROVED, 200)[:, 0].mean())


def right_of(axes):
    """The words to the right of rows."""
    (right,) = axes.child_axes
    return [label.get_text() for label in right.get_yticklabels()]


def test_steps_say_how_many_iterations_were_planted(figures):
    _, below = figures[Figure.STEPS].axes
    shown = [float(text.split()[0].replace(",", "")) for text in right_of(below)]
    assert shown[:-1] == pytest.approx([*NEEDED.values()], rel=0.05), "two digits, noise of 1 %"
    assert right_of(below)[-2] == "200 (1×)"
    assert shown[-1] == pytest.approx(NEEDED[DOUBLE], rel=0.15), "a mean over setups"


def test_a_step_that_does_not_arrive_is_shown_as_a_bound(small, project):
    def shortened(table):
        if "variant" not in table:
            return table
        return table[(table["variant"] != RITTER) | (table["iterations"] <= 1000)]

    figure = rendering.drawn(Figure.STEPS, Evidence(small, project(shortened)))
    assert right_of(figure.axes[1])[0] == "> 1,000 (5×)"
    plt.close(figure)


def test_contrasts_show_every_setup_and_what_was_found(figures, evidence, small):
    shown, found = rows(evidence), evidence.findings()
    assert {row.claim.id for row in shown} == {*LABELS}
    words = [text for axes in figures[Figure.CONTRASTS].axes for text in right_of(axes)]
    theta = found["theta-increments"]
    assert f"{theta.estimates[0].value:.3g} {theta.verdict}" in words
    assert theta.estimates[0].value == pytest.approx(1 / 2.5, rel=0.1), "as planted"
    drawn = [dots.get_offsets() for dots in figures[Figure.CONTRASTS].axes[0].collections]
    of_setups = [dots for dots in drawn if len(dots) == evidence.study.campaign.setups]
    dots = np.concatenate(of_setups)[:, 0]
    ratios = [row.numbers for row in shown if not row.is_share]
    assert np.allclose(np.sort(dots), np.sort(np.concatenate(ratios)))
    estimands = {claim.id: getattr(claim, "estimand", None) for claim in claims(small)}
    own = {name for name in estimands if estimands[name]}
    assert {name for name in own if not isinstance(estimands[name], Crossing)} == {*LABELS}
    assert isinstance(estimands["figure-1"], Remaining)


def test_the_benchmark_shows_two_scenarios(figures, evidence):
    figure, table = figures[Figure.BENCHMARK], evidence.table("benchmark.csv")
    assert [axes.get_title(loc="left") for axes in figure.axes] == [
        "the paper's damage",
        "gears and sag as well",
    ]
    own = table.query("scenario == 'links_encoders' and learner == 'improved'")
    moves, errors = curve(figure.axes[0], "improved")
    assert np.allclose(moves, own["moves"]) and np.allclose(errors, own["position_error_cm"])
    (axes,) = figures[Figure.REAL_ARM].axes
    table = evidence.table("real.csv").query("learner == 'improved'")
    poses, errors = curve(axes, "improved on a twin")
    assert poses.tolist() == [5, 50], "a thousand are far away"
    assert errors[0] == pytest.approx(table["position_error_mm"].iloc[0])


def test_a_default_run_draws_what_a_study_has_results_for(small, project, tmp_path, monkeypatch):
    every = [figure.file for figure in Figure if figure not in APART]
    monkeypatch.chdir(project())
    assert figures_of(small) == every and every[0] == "figure1"
    campaign = {Figure.STEPS.file, Figure.CONTRASTS.file}
    without_campaign = [name for name in every if name not in campaign]
    other = changed(small, name="other")
    assert figures_of(other) == without_campaign
    monkeypatch.chdir(tmp_path)
    assert figures_of(small) == without_campaign, "no setup is measured"
    quick = changed(other, experiments={"evidence": False})
    trained = Figure.FIGURE_1, Figure.LEARNERS, Figure.SCENARIOS
    assert figures_of(quick) == [figure.file for figure in trained]
