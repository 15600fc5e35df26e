"""The simulated arm, its camera, and what watches it are those of the examples' rehearsal."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "rehearsal"))
