"""Figures: drawn from what they declare, for any study, and the same on every machine."""

import runpy
from importlib import import_module

import numpy as np
import pytest

from replication.pages.findings import figures as figures_of_findings
from replication.plots.palette import BOTH, FAILS, HOLDS, OTHER, STYLES, UNKNOWN, styles_of
from replication.plots.registry import FIGURES, draw, drawn
from replication.plots.steady import LOG, rounded
from replication.plots.style import STYLE, plt, save
from tests.conftest import ROOT
from tests.synthetic import NOISE, OF_SEARCHES, Synthetic, evidence_of, few_resamples, without_one


def bytes_of(figure: str, evidence, folder) -> list[bytes]:
    paths = [folder / f"{figure}{suffix}" for suffix in (".svg", ".png")]
    with plt.rc_context(STYLE):
        save(draw(figure, evidence), *paths)
    return [path.read_bytes() for path in paths]


@pytest.mark.slow
@few_resamples()
@pytest.mark.parametrize("figure", FIGURES)
def test_noise_in_the_last_digits_changes_no_byte(figure, synthetic, disturbed, tmp_path):
    evidence = (evidence_of(figure, results) for results in (synthetic, disturbed))
    first, again = (bytes_of(figure, its, tmp_path) for its in evidence)
    assert first == again and min(map(len, first)) > 5000


@pytest.mark.slow
def test_the_committed_pictures_of_ideas_are_those_that_their_code_draws(tmp_path):
    runpy.run_path(str(ROOT / "figures" / "ideas.py"))["draw"](tmp_path)
    drawings = sorted(tmp_path.iterdir())
    assert len(drawings) == 8
    assert all(
        path.read_bytes() == (ROOT / "figures" / path.name).read_bytes() for path in drawings
    )


@few_resamples()
@pytest.mark.parametrize("figure", FIGURES)
def test_a_figure_reads_what_it_declares_and_nothing_else(figure, synthetic, tmp_path):
    evidence = evidence_of(figure, synthetic)
    # of a table in pieces, those are read that are declared
    whole = [
        name for name in evidence.files if "/horizon_" not in name and "/outcomes_" not in name
    ]
    for name, less in without_one(evidence):
        if name in whole[:3] or name in evidence.facts:
            with pytest.raises(KeyError), plt.rc_context(STYLE):
                draw(figure, less)
            plt.close("all")


def smaller(study, learners, **update):
    """The study with these learners on the paper's damage, and no evidence."""
    plan = study.experiments.model_copy(
        update={
            "scenarios": ("links_encoders",),
            "learners": learners,
            "beside": (),
            "switches": False,
            "ladder": {},
            "robots": (),
            "ensemble": {},
            "evidence": False,
        }
        | update
    )
    return study.model_copy(update={"name": "small", "experiments": plan})


@pytest.mark.parametrize(
    ("learners", "update", "figures"),
    [
        (("improved", "ritter_200"), {}, ["figure1", "figure2", "figure3"]),
        (("ritter",), {}, ["figure2", "figure3"]),
        (
            ("improved", "ritter_200"),
            {"beside": ("ritter_double_200", "ritter_double")},
            ["figure1", "figure2", "figure3", "figure4"],
        ),
    ],
)
@few_resamples()
def test_a_study_draws_what_it_has_the_results_for(few, tmp_path, learners, update, figures):
    its = smaller(few, learners, **update)
    synthetic = Synthetic(tmp_path, its)
    assert drawn(its, synthetic.request) == figures
    for figure in figures:
        bytes_of(figure, synthetic.evidence(FIGURES[figure].needs), tmp_path)


def test_a_learner_beside_has_a_row_of_its_own(few, tmp_path):
    its = smaller(few, ("improved", "ritter_200"), beside=("ritter_double_200", "ritter_double"))
    synthetic = Synthetic(tmp_path, its, {"ritter_double_200": 0.2})
    with plt.rc_context(STYLE):
        figure = draw("figure4", synthetic.evidence(FIGURES["figure4"].needs))
    axes = figure.axes[0]
    labels = [label.get_text() for label in axes.get_yticklabels()]
    assert labels == ["ritter double 200,\nanother learner"], "10,000 iterations are not compared"
    assert "rows of other learners: their error over that of" in axes.get_xlabel()
    # four searches each: three standard errors of the ratio
    ratios = [float(text.get_text()) for text in axes.texts if text.get_text()[0].isdigit()]
    assert ratios == pytest.approx([2, 0.05], rel=3 * OF_SEARCHES * np.sqrt(2 / 4))
    plt.close(figure)


def test_another_study_s_first_figure_names_robot_and_damage(few, tmp_path):
    synthetic = Synthetic(tmp_path, smaller(few, ("improved",)))
    with plt.rc_context(STYLE):
        figure = draw("figure1", synthetic.evidence(FIGURES["figure1"].needs))
    assert "UR10, forearm_link 4 cm" in figure.get_suptitle()
    plt.close(figure)


def test_a_colour_means_one_thing_throughout():
    """A learner, its kin of other iterations, an error, or a verdict."""
    of_learners = {style.color for style in STYLES.values()}
    others = [*(error.color for error in BOTH), HOLDS, FAILS]
    others += [color for color, _ in (*OTHER.values(), *UNKNOWN)]
    assert len({*others}) == len(others)
    assert not {*others} & of_learners
    assert len(of_learners) == len(STYLES)


def test_every_figure_has_a_drawing_and_a_text_in_the_report():
    for figure, its in FIGURES.items():
        assert callable(getattr(import_module(its.home), figure))
        text = ROOT / "workflow" / "report" / f"{figure}.html"
        assert text.exists() == (its.part in ("trainings", "evidence"))
    assert set(figures_of_findings()) < set(FIGURES)


def test_rounding_keeps_plain_numbers_and_moves_nothing_that_is_seen():
    values = np.array([0.0, 1, 3, 0.25, 1000, -7.5, 12345.0, 1.2345e-3])
    assert np.allclose(rounded(values), values, rtol=1e-3)
    assert rounded([0, 1, 3, 0.25, 1000]).tolist() == [0, 1, 3, 0.25, 1000]
    halves = np.array([0.12345, 2.5005, 10.015])
    assert (rounded(halves) == rounded(halves * (1 + NOISE))).all()
    assert (rounded(halves) == rounded(halves * (1 - NOISE))).all()
    assert rounded([3e-11], 0.1).tolist() == [0], "what rounding leaves is nothing on this axis"


def test_logarithms_of_an_axis_have_no_last_digits():
    figure, axes = plt.subplots()
    axes.set_xscale(LOG)
    value = 0.1234567
    near = np.nextafter(value, 1)
    drawn_at = axes.transData.transform([(value, 0.5), (near, 0.5)])
    assert drawn_at[0, 0] == drawn_at[1, 0]
    plt.close(figure)


def test_every_learner_looks_like_itself_and_unlike_the_others(study):
    benchmark = styles_of(study.benchmark.learners)
    assert set(study.benchmark.learners) == set(STYLES)
    assert len({(style.color, style.marker) for style in benchmark.values()}) == len(benchmark)
    defaults = styles_of(study.experiments.learners)
    assert defaults["ritter"] is STYLES["ritter"] and defaults["ritter_200"].label == "Ritter"
    assert len({style.color for style in defaults.values()}) == 3
    unknown = styles_of(["improved", "mine", "another"])
    assert unknown["mine"].label == "mine" and unknown["mine"].color != unknown["another"].color
