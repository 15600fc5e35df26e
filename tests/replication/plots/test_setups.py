"""Figures of the alternative setups, of planted tables; and how legible figures on pages are."""

import re
from functools import cache
from io import StringIO
from itertools import combinations, pairwise
from unittest import mock

import numpy as np
import pandas as pd
import pytest
from matplotlib.collections import LineCollection, PathCollection
from matplotlib.colors import to_hex, to_rgb, to_rgba
from matplotlib.text import Text

from replication.config.shipped import DESIGN, FACTORS, REFERENCE
from replication.config.universes import Factors
from replication.config.values import from_file
from replication.judgement.claims import CLAIMS
from replication.pages.words import headline, level_in_words
from replication.plots.palette import BORDER, BOTH, FAILS, HOLDS, OTHER, STYLES, UNKNOWN
from replication.plots.registry import FIGURES, draw, drawn, possible
from replication.plots.style import STYLE, plt
from tests.conftest import ROOT
from tests.replication.recording.test_colours import FEWEST, SEEN, ciede2000, lab, linear
from tests.synthetic import Synthetic, evidence_of, few_resamples

PAGE = 830  # pixels: as wide as pages show figures
LEAST = 9  # pixels
NUMBERED = re.compile(r"^Figure \d+: ")
WHITE = to_rgba("white")
COLUMNS = "maps_improved", "maps_ritter"
MOVED = 1.6  # times, by the effort of the search
MEANT = {style.color for style in (*STYLES.values(), *BOTH)} | {HOLDS, FAILS}
MEANT |= {color for color, _ in (*OTHER.values(), *UNKNOWN)}


@pytest.fixture(scope="module")
def planted(few, tmp_path_factory) -> Synthetic:
    """Theta helps and depends on effort; schedule has no effect; the Jacobian harms, but
    not in the reference study."""
    its = Synthetic(tmp_path_factory.mktemp("planted"), few)
    table = its.outcomes({"schedule_improved": 1.0, "jacobian_improved": 1.5})
    effort = pd.read_csv(ROOT / DESIGN)["effort"].to_numpy()[table["universe"]]
    table["theta_improved"] *= np.where(effort == "rough", MOVED, 1.0)
    horizon = its.horizon().assign(bound=lambda its: (its["universe"] < 5).astype(int))
    made = its.campaign
    its.campaign = lambda: made(outcomes=table, horizon=horizon)
    its.conclude()
    return its


@pytest.fixture(scope="module")
def figures(planted):
    """All, drawn."""
    found = {}
    with plt.rc_context(STYLE), few_resamples():
        for name in FIGURES:
            found[name] = draw(name, evidence_of(name, planted))
            texts(found[name])  # it lays out: before, nothing is where it will be
    yield found
    plt.close("all")


@cache
def texts(figure) -> list[Text]:
    """Those that are drawn: of ticks beyond an axis there are labels, too."""
    found, own = {}, Text.draw

    def draws(text, renderer):
        found[id(text)] = text
        own(text, renderer)

    with mock.patch.object(Text, "draw", draws):
        figure.draw_without_rendering()
    return [text for text in found.values() if text.get_visible() and text.get_text().strip()]


@pytest.mark.parametrize("name", FIGURES)
def test_a_figure_can_be_read_on_a_page(figures, name):
    figure = figures[name]
    pixels = PAGE / (72 * figure.get_figwidth())
    small = {text.get_text(): text.get_fontsize() * pixels for text in texts(figure)}
    assert min(small.values()) >= LEAST, min(small.items(), key=lambda item: item[1])


@pytest.mark.parametrize("name", FIGURES)
def test_no_words_stand_on_others_or_leave_the_figure(figures, name):
    figure = figures[name]
    boxes = [(text.get_text(), text.get_window_extent()) for text in texts(figure)]
    for (one, its), (other, another) in combinations(boxes, 2):
        assert not its.padded(-1).overlaps(another.padded(-1)), (one, other)
    for text, box in boxes:
        inside = box.x0 >= 0 and box.x1 <= figure.bbox.x1 and box.y0 >= 0
        assert inside and box.y1 <= figure.bbox.y1, text


def traced(corners: np.ndarray) -> np.ndarray:
    """Points (n, 2) on the way from corner to corner, a pixel or less apart."""
    pieces = [np.linspace(*way, 2 + int(np.ptp(way, axis=0).max())) for way in pairwise(corners)]
    return np.concatenate([corners, *pieces])


def inked(axes) -> np.ndarray:
    """Pixels (n, 2) of lines, bars and signs of the data."""
    found = [np.empty((0, 2))]
    for line in axes.lines:
        corners = line.get_transform().transform(line.get_xydata())
        corners = corners[np.isfinite(corners).all(axis=1)]
        found.append(corners if line.get_linestyle() == "None" else traced(corners))
    for its in axes.collections:
        if isinstance(its, LineCollection):
            found += [traced(its.get_transform().transform(part)) for part in its.get_segments()]
        elif isinstance(its, PathCollection):
            found.append(its.get_offset_transform().transform(its.get_offsets()))
    points = np.concatenate(found)
    box = axes.get_window_extent()
    inside = (points >= box.min) & (points <= box.max)
    return points[inside.all(axis=1)]


@pytest.mark.parametrize("name", FIGURES)
def test_no_words_stand_on_data(figures, name):
    for axes in figures[name].axes:
        points = inked(axes)
        for text in set(texts(figures[name])) & set(axes.texts):
            frame = text.get_bbox_patch()
            if frame is not None and frame.get_facecolor() == WHITE:
                continue  # on a line that it interrupts
            box = text.get_window_extent().padded(-1)
            on = (points > box.min) & (points < box.max)
            assert not on.all(axis=1).any(), text.get_text()


@pytest.mark.parametrize("name", FIGURES)
def test_a_title_says_what_was_found(figures, name):
    """In numbers."""
    title = NUMBERED.sub("", figures[name].get_suptitle())
    assert re.search(r"\d", title) and "..." not in title, title


def test_legends_hide_no_data_and_the_grid_lies_below(figures):
    for figure in figures.values():
        legends = [*figure.legends, *filter(None, (axes.get_legend() for axes in figure.axes))]
        for axes in figure.axes:
            assert axes.get_axisbelow() is True
            for legend in legends:
                assert not legend.get_window_extent().overlaps(axes.get_window_extent())


@pytest.fixture(scope="module")
def colours(figures) -> dict[str, set[str]]:
    """Those in the drawings' texts; Figure 8 shows widths, by a scale of its own, and signs."""
    found = {}
    for name in FIGURES.keys() - {"figure8"}:
        drawing = StringIO()
        figures[name].set_layout_engine("none")  # all is where it will be
        with plt.rc_context({"svg.fonttype": "none"}):  # no outlines of letters: they take seconds
            figures[name].savefig(drawing, format="svg")
        found[name] = {*re.findall(r"#[0-9a-f]{6}\b", drawing.getvalue())}
    return found


def is_a_shade_of(colour: np.ndarray, full: np.ndarray) -> bool:
    """Whether a colour (3,) is this one, or a paler one towards white."""
    gone, most = 1 - colour, 1 - full
    return np.allclose(gone, most * gone.max() / most.max(), atol=0.02)


def test_every_colour_of_a_figure_has_its_meaning(colours):
    known = [np.array(to_rgb(color)) for color in (*MEANT, "black")]
    for name, used in colours.items():
        shades = {color: np.array(to_rgb(color)) for color in used}
        strange = [
            color
            for color, its in shades.items()
            if not any(is_a_shade_of(its, full) for full in known)
        ]
        assert used and not strange, name


@pytest.mark.parametrize("seen", SEEN)
def test_colours_of_a_figure_differ_to_everyone(colours, seen):
    """As much as those of recordings."""
    meant = {to_hex(color) for color in MEANT - {BORDER["color"]}}
    for name, used in colours.items():
        shades = {
            color: lab(SEEN[seen] @ linear(255 * np.array(to_rgb(color)))) for color in used & meant
        }
        shades["paper"] = lab(np.ones(3))
        for one, other in combinations(shades, 2):
            assert ciede2000(shades[one], shades[other]) >= FEWEST, (name, one, other)


def said(figure) -> str:
    return "\n".join(text.get_text() for text in texts(figure))


def test_figure_14_judges_as_the_claims_do(figures, planted):
    judged = {claim["id"]: claim for claim in evidence_of("figure14", planted).claims()}
    assert judged["schedule"]["systems"]["improved system"]["verdict"] == "no effect"
    verdicts = [
        judged[claim.id]["systems"][system]["verdict"]
        for claim in CLAIMS
        for system in claim.across
    ]
    shown = [text.get_text() for text in texts(figures["figure14"])]
    assert sorted(text for text in shown if text in set(verdicts)) == sorted(verdicts)
    leading = [next(iter(judged[claim.id]["systems"].values())) for claim in CLAIMS if claim.across]
    supported = sum(its["verdict"] == "supported" for its in leading)
    title = figures["figure14"].get_suptitle()
    assert f"{supported} of {len(leading)} claims" in title
    assert "1 no effect, 1 undecided" in title


@few_resamples()
def test_figure_14_counts_setups_only_where_luck_is_small(figures, planted):
    evidence = evidence_of("figure14", planted)
    models = [its for claim in CLAIMS for its in claim.setups(evidence).values()]
    counted = sum(its.holds is not None for its in models)
    assert 0 < counted < len(models)
    assert said(figures["figure14"]).count(" if all were alike") == counted


def test_figure_14_says_of_how_many_setups_a_number_is_known(figures, planted):
    horizons = planted.study.universes.horizons
    known = sum(number >= 5 for number in horizons)
    judged = {claim["id"]: claim for claim in evidence_of("figure14", planted).claims()}
    text = said(figures["figure14"])
    assert f" over {known} of {len(horizons)} setups\n" in text
    assert f"\nreference study: {headline(judged['speed-up'])}\n" in text


def test_figure_15_names_the_planted_choice_in_words(figures, planted):
    evidence = evidence_of("figure15", planted)
    theta = next(claim for claim in CLAIMS if claim.id == "theta-increments")
    with few_resamples():
        effects = theta.setups(evidence)["improved system"].effects(
            evidence.rng("effects", theta.id, "improved system")
        )
    strongest = effects.iloc[0]
    assert strongest["factor"] == "effort" and strongest["low"] < MOVED < strongest["high"]
    text = said(figures["figure15"])
    assert "the effort of the search is: rough,\ninstead of: full" in text
    assert f"{strongest['effect']:.2f} times (" in text
    assert "No choice moves these beyond chance" in text


def test_every_choice_has_words(study):
    labels = from_file(ROOT / FACTORS).plain()
    assert [*labels] == [*Factors.model_fields]
    for factor, levels in study.universes.factors:
        words = [level_in_words(labels[factor], level) for level in levels]
        assert len({*words}) == len(levels) and not any("_" in word for word in words)
        assert {*labels[factor]} == {"asks", *map(str, levels)}


def test_figures_of_setups_are_drawn_once_all_are_measured(few, tmp_path):
    its = Synthetic(tmp_path, few)
    of_setups = {"figure14", "figure15"}
    assert not of_setups & {*drawn(few, its.request)}
    assert "multiverse" not in possible(["ideas"], its.request)
    its.campaign()
    assert of_setups <= {*drawn(few, its.request)}
    assert "multiverse" in possible(["ideas"], its.request)
    other = few.model_copy(update={"name": "other"})
    assert not of_setups & {*drawn(other, Synthetic(tmp_path / "other", other).request)}


def test_the_bar_of_separate_maps_is_the_nested_comparison(figures, planted):
    reference = evidence_of("figure4", planted).table(REFERENCE)
    axes = figures["figure4"].axes[0]
    assert axes.get_yticklabels()[0].get_text() == "separate maps"
    expected = {f"{np.exp(np.log(reference[column]).mean()):.2f}" for column in COLUMNS}
    assert expected <= {text.get_text() for text in axes.texts}
