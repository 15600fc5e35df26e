import numpy as np
import pytest

from replication.mapping import RATES, WIDTHS, kohonen
from replication.mapping.quantisation import quantisation


def test_the_kohonen_rule_agrees_with_itself_written_out_cell_by_cell():
    rng = np.random.default_rng(1)
    starts, poses = rng.uniform(-1, 1, (2, 6, 3)), rng.uniform(-1, 1, (2, 30, 3))
    found = kohonen(starts, poses, (3, 2))
    places = [np.array([i, j]) for i in range(3) for j in range(2)]
    for run in range(2):
        w = starts[run].copy()
        for t, u in enumerate(poses[run]):
            winner = int(np.argmin([np.linalg.norm(u - each) for each in w]))
            width = WIDTHS[0] * (WIDTHS[1] / WIDTHS[0]) ** (t / 30)
            rate = RATES[0] * (RATES[1] / RATES[0]) ** (t / 30)
            for i in range(6):
                d = np.linalg.norm(places[i] - places[winner])
                w[i] = w[i] + rate * np.exp(-(d**2) / (2 * width**2)) * (u - w[i])
        assert np.allclose(found[run], w, rtol=0, atol=1e-12)


@pytest.fixture(scope="module")
def line():
    """Two cells on a line, for which all that is known: s / sqrt(3) for a box of half-width s."""
    return quantisation(7, shape=(2,), iterations=(2, 2000), seeds=4)


def test_every_placement_of_two_cells_on_a_line_is_as_good_as_calculated(line):
    assert line.columns.tolist() == ["placement", "seed", "distance"]
    by_placement = line.groupby("placement", sort=False)["distance"]
    names = ["boxes", "faces", "kohonen_2", "kohonen_2000", "kmeans"]
    assert by_placement.size().to_dict() == dict.fromkeys(names, 4)
    best = 0.5 / np.sqrt(3)
    mean = by_placement.mean()
    assert mean["boxes"] == pytest.approx(best, rel=0.01)
    assert mean["faces"] == pytest.approx(2 * best, rel=0.01)
    assert mean["kmeans"] == pytest.approx(best, rel=0.01)
    assert mean["kohonen_2000"] == pytest.approx(best, rel=0.05)
    assert mean["kohonen_2"] > 1.1 * best, "two poses cannot place two cells"
