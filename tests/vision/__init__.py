"""Tests with pictures: all are skipped where OpenCV is not there."""

import pytest

pytest.importorskip("cv2", reason="needs OpenCV, of the extra `vision`")
