"""MuJoCo, imported so that it draws without a screen where there is EGL to do so."""

import os
import sys
from ctypes.util import find_library

if sys.platform == "linux" and find_library("EGL"):  # without EGL, the import would fail
    os.environ.setdefault("MUJOCO_GL", "egl")  # MuJoCo looks here when it is imported

import mujoco

__all__ = ["mujoco"]
