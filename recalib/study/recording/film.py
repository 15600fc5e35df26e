"""A short moving picture of a recording: the arm misses, learns and hits, for pages."""

import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

from recalib.storage import whole
from recalib.study.recording.acts import ACT, ARM, LEARNING
from recalib.study.recording.picture import take_pictures

SHOWN = 6.4  # seconds at the end of each act: the last poses that the arm visits
WINDOW = 1160, 600  # pixels, of which the arm has five eighths
FRAME, LAST = 100, 2000  # milliseconds


def moments() -> np.ndarray:
    """Seconds (frame,) of the recording: visits twice, learning five times as fast as in it."""
    visits = np.arange(ACT - SHOWN, ACT, 0.2)
    learning = ACT + np.arange(0, LEARNING, 0.5)
    return np.concatenate([visits, learning, visits + ACT + LEARNING])


def take_film(recording: Path, film: Path) -> None:
    """Write an animated WebP of what the viewer shows of the arm.

    Needs and raises what `picture.take_pictures` does.
    """
    with tempfile.TemporaryDirectory() as folder:
        times = {Path(folder) / f"{i}.png": second for i, second in enumerate(moments())}
        take_pictures(recording, times, view=ARM, window=WINDOW)
        first, *others = [Image.open(png).convert("RGB") for png in times]
    with whole(film) as temporary:
        first.save(
            temporary,
            format="WebP",
            save_all=True,
            append_images=others,
            duration=[FRAME] * len(others) + [LAST],
            loop=0,
            quality=75,
        )
