"""Arms that move and measure by themselves: a calibration that goes on while it is watched."""

import os
import sys

if sys.platform == "linux":  # MuJoCo draws without a screen; it looks here when it is imported
    os.environ.setdefault("MUJOCO_GL", "egl")
