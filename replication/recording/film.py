"""The film of a recording, from screenshots of the viewer, which runs without a screen."""

import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image
from rerun.chunk import RrdReader
from rerun.experimental import ViewerClient

from recalib.errors import RecalibError
from recalib.files.storage import whole
from replication.recording.phases import ARM, CLOCK, VISIT
from replication.recording.viewer import HERE, PATIENCE, answer, free_port, viewer

REPAINTS = 40  # until the viewer's notices disappear: their duration is in repaints, not seconds
WINDOW = "1490x800"  # pixels; five eighths of the width, the arm's view, are as wide as a page
ZOOM = 10  # steps of 10 % by which text is enlarged, to be legible on a phone
SHOWN = 3 * VISIT  # frames at the end of each phase of visits
STEP = 5  # frames of a visit from one picture to the next
FRAME, LAST = 100, 1500  # milliseconds


class _Patient:
    """A client of the viewer that retries on a busy machine; Rerun's own gives up after 15 s."""

    def __init__(self, process: subprocess.Popen[bytes], client: ViewerClient):
        self._process, self._client = process, client

    def __getattr__(self, method: str) -> Callable[..., Any]:
        ask = getattr(self._client, method)
        return lambda *arguments, **named: answer(self._process, partial(ask, *arguments, **named))


def take_film(recording: Path, film: Path) -> None:
    """Write an animated WebP of the viewer's picture of the arm.

    It shows the ends of both phases of visits and, with the same number of pictures, learning. The
    film pauses after each of the three.

    Needs a Vulkan driver; a software driver suffices, such as Debian's mesa-vulkan-drivers.
    Raises RecalibError if the viewer does not start or does not load the recording.
    """
    start, *others = _pictures(recording, _frames(recording))
    with whole(film) as temporary:
        start.save(
            temporary,
            format="WebP",
            save_all=True,
            append_images=others,
            duration=3 * ([FRAME] * (len(others) // 3) + [LAST]),
            loop=0,
            quality=75,
        )


def _frames(recording: Path) -> np.ndarray:
    chunks = RrdReader(recording).store().stream().to_chunks()
    batches = [chunk.to_record_batch() for chunk in chunks]
    numbers = [batch[CLOCK].to_pylist() for batch in batches if CLOCK in batch.schema.names]
    first, last = min(map(min, numbers)), max(map(max, numbers))
    visits = np.arange(max(first, -SHOWN), 0, STEP)
    # first + last is the last frame of learning, because both phases of visits are equally long
    learning = (first + last) * np.linspace(0, 1, len(visits)) ** 2  # denser while errors fall fast
    return np.concatenate([visits, learning.astype(int), last + 1 + visits])


def _pictures(recording: Path, frames: np.ndarray) -> list[Image.Image]:
    """The viewer's pictures of the arm in these frames, in 256 colours, which look the same."""
    taken: list[Image.Image] = []
    with _client() as client, tempfile.TemporaryDirectory() as folder:
        _load(client, recording)
        for _ in range(ZOOM):
            client.run_command("ui.zoom_in_ui")
        for repaint in range(REPAINTS):
            _show(client, -repaint)
        views = {shown.name: shown.view_id for shown in client.get_state().views}
        for frame in frames.tolist():
            _show(client, frame)
            png = Path(folder, f"{len(taken)}.png")
            client.save_screenshot(str(png), views[ARM])
            with Image.open(png) as image:
                few = image.convert("RGB").quantize(256, dither=Image.Dither.NONE)
            taken.append(few.convert("RGB"))
    return taken


@contextmanager
def _client() -> Iterator[_Patient]:
    """A viewer without a screen. `ViewerClient.spawn` would listen to the whole network."""
    port = free_port()
    options = "--headless", "--hide-welcome-screen", "--port", port, "--window-size", WINDOW
    with tempfile.TemporaryFile("w+", encoding="utf-8") as log:
        try:
            with viewer(*options, log=log) as process:
                url = f"rerun+http://{HERE}:{port}/proxy"
                yield _Patient(process, answer(process, lambda: ViewerClient(url)))
        except (ConnectionError, RuntimeError):  # without a driver it may only fail when it draws
            log.seek(0)
            reason = next((line.strip() for line in log if "panicked" in line), "no answer")
            raise RecalibError(
                f"the viewer does not run here ({reason}); it needs a Vulkan driver,"
                " such as Debian's mesa-vulkan-drivers"
            ) from None


def _load(client: _Patient, recording: Path) -> None:
    client.open(str(recording.resolve()))
    deadline = time.monotonic() + PATIENCE
    while (state := client.get_state()).loading or not state.recordings:
        if time.monotonic() > deadline:
            raise RecalibError(f"the viewer did not load {recording} within {PATIENCE:.0f} s")
        time.sleep(0.1)


def _show(client: _Patient, frame: int) -> None:
    client.set_time(CLOCK, sequence=frame, play_state="paused")
    time.sleep(0.05)
