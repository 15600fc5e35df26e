"""The notebook, as its cells run one after the other, and with sliders elsewhere."""

import importlib.util
from types import SimpleNamespace

import numpy as np
import pytest

from tests.conftest import ROOT

pytest.importorskip("marimo", reason="needs marimo: make notebook, or pip install .[notebook]")
pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def notebook():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(ROOT / "examples")
        path = ROOT / "examples" / "notebook.py"
        spec = importlib.util.spec_from_file_location("notebook", path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        yield module.app


@pytest.fixture(scope="module")
def cells(notebook) -> dict:
    """What the cells define, as the sliders stand at first."""
    return notebook.run()[1]


def test_the_damaged_arm_misses_learns_and_hits_as_it_is_drawn(cells):
    before, by_map, by_model = cells["misses"].values()
    assert before > 5 and by_map < 0.1 * before and by_model < 0.1 * by_map
    moves = {name: history.moves[-1] for name, history in cells["histories"].items()}
    assert moves == {"the paper's map": 400, "identification": 5}
    wanted = cells["wanted"][0, [0, 2], 3]
    ends = {name: np.linalg.norm(points[-1] - wanted) for name, points in cells["real"].items()}
    assert np.allclose(cells["believed"][-1], wanted, atol=1e-5)
    assert all(100 * ends[name] <= miss + 1e-6 for name, miss in cells["misses"].items())
    assert ends["as desired"] > 10 * ends["corrected by the map"]


@pytest.mark.parametrize("end", ["start", "stop"])
def test_at_the_ends_of_the_sliders_the_arm_learns_as_well(notebook, cells, end):
    sliders = cells["damage"].elements
    stand = SimpleNamespace(value={name: getattr(slider, end) for name, slider in sliders.items()})
    _, moved = notebook.run(defs={"damage": stand})
    assert moved["damaged"].offsets.any() and moved["misses"] != cells["misses"]
    for history in moved["histories"].values():
        assert not history.refused.any()
        assert history.position_error[-1] < 0.15 * history.position_error[0]
