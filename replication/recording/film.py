"""Pictures and films of recordings, taken by the real viewer without a screen."""

import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
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
from replication.recording.phases import ARM, BEFORE, CLOCK, VISIT
from replication.recording.viewer import HERE, PATIENCE, answer, free_port, viewer

WINDOW = 1400, 800  # pixels
TOP_BAR = 37  # pixels of it: the window's own bar, which shows nothing of the recording
REPAINTS = 40  # until the viewer's notices have gone: they count repaints, not seconds

FILM = 1490, 800  # pixels of the window, of which the arm has five eighths: as wide as a page
ZOOM = 5  # steps of a tenth, by which words are larger: they can be read on a telephone
SHOWN = 4 * VISIT  # frames at the end of each phase of visits
STEP = 8  # frames of a visit from one picture to the next
FRAME, LAST = 100, 2000  # milliseconds


class _Patient:
    """A viewer's client that asks again on a busy machine: rerun's own gives up after 15 s."""

    def __init__(self, process: subprocess.Popen[bytes], client: ViewerClient):
        self._process, self._client = process, client

    def __getattr__(self, method: str) -> Callable[..., Any]:
        ask = getattr(self._client, method)
        return lambda *its, **named: answer(self._process, partial(ask, *its, **named))


def before_and_after(recording: Path, before: Path, after: Path) -> None:
    """Pictures of the arm before and after its recalibration; see `take_pictures`."""
    first, last = ends(recording)
    # the last frame of learning: its number is one of iterations, and the arm rests there, too
    take_pictures(recording, {before: BEFORE, after: first + last})


def take_pictures(
    recording: Path,
    pictures: Mapping[Path, int],
    view: str | None = None,
    window: tuple[int, int] = WINDOW,
    zoom: int = 0,
) -> None:
    """Write what the viewer shows of a recording, one PNG for each frame.

    Args:
        pictures: the frame that each shows.
        view: name of the one that is shown, such as `phases.ARM`; all that the window shows
            unless given.
        window: its size in pixels.
        zoom: steps of a tenth by which words are larger.

    Needs a Vulkan driver; one in software will do, such as Debian's mesa-vulkan-drivers.
    Raises RecalibError where the viewer does not start or does not load the recording.
    """
    with _client(window) as client:
        _load(client, recording)
        for _ in range(zoom):
            client.run_command("ui.zoom_in_ui")
        for repaint in range(REPAINTS):
            _show(client, -repaint)
        views = {shown.name: shown.view_id for shown in client.get_state().views}
        for png, frame in pictures.items():
            _show(client, frame)
            with whole(png) as temporary:
                client.save_screenshot(str(temporary.resolve()), views[view] if view else None)
                _shrink(temporary, 0 if view else TOP_BAR)


def take_film(recording: Path, film: Path) -> None:
    """Write an animated WebP of what the viewer shows of the arm.

    It shows the ends of both phases of visits, and learning in as many steps as one of them.
    Needs and raises what `take_pictures` does.
    """
    first, last = ends(recording)
    visits = np.arange(max(first, -SHOWN), 0, STEP)
    learning = np.linspace(0, first + last, len(visits), dtype=int)
    frames = np.concatenate([visits, learning, last + 1 + visits])
    with tempfile.TemporaryDirectory() as folder:
        shown = {Path(folder, f"{number}.png"): int(frame) for number, frame in enumerate(frames)}
        take_pictures(recording, shown, ARM, FILM, ZOOM)
        start, *others = [Image.open(png).convert("RGB") for png in shown]
    with whole(film) as temporary:
        start.save(
            temporary,
            format="WebP",
            save_all=True,
            append_images=others,
            duration=[FRAME] * len(others) + [LAST],
            loop=0,
            quality=75,
        )


def ends(recording: Path) -> tuple[int, int]:
    """The first frame and the last one, in which the arm rests at the last pose, recalibrated."""
    chunks = RrdReader(recording).store().stream().to_chunks()
    batches = [chunk.to_record_batch() for chunk in chunks]
    frames = [its[CLOCK].to_pylist() for its in batches if CLOCK in its.schema.names]
    return min(map(min, frames)), max(map(max, frames))


@contextmanager
def _client(window: tuple[int, int]) -> Iterator[_Patient]:
    """A viewer without a screen. `ViewerClient.spawn` would listen to the whole network."""
    port = free_port()
    options = "--headless", "--hide-welcome-screen", "--port", port
    size = "--window-size", "{}x{}".format(*window)
    with tempfile.TemporaryFile("w+", encoding="utf-8") as log:
        try:
            with viewer(*options, *size, log=log) as process:
                url = f"rerun+http://{HERE}:{port}/proxy"
                yield _Patient(process, answer(process, lambda: ViewerClient(url)))
        except (ConnectionError, RuntimeError):  # it also ends later, where it first has to draw
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


def _shrink(png: Path, top: int) -> None:
    """Cut the top off, and keep 256 colours: a third of the bytes, the same to the eye."""
    with Image.open(png) as image:
        picture = image.convert("RGB").crop((0, top, *image.size))
    picture.quantize(256, dither=Image.Dither.NONE).save(png, optimize=True)
