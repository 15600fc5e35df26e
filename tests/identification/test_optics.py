import numpy as np
import pytest

from recalib.identification.model.optics import _whitening


def test_a_picture_far_off_does_not_change_what_a_typical_one_weighs():
    spread = np.stack([np.diag([4.0, 4.0, 4.0, 9.0, 9.0, 9.0])] * 5)
    spread[-1] *= 1e4
    assert _whitening(spread)[:-1] == pytest.approx(np.stack([np.eye(6)] * 4))
    assert _whitening(spread)[-1] == pytest.approx(np.eye(6) / 100)
