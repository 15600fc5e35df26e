"""Pictures of recordings, taken by the real viewer without a screen."""

import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from PIL import Image
from rerun.experimental import ViewerClient

from recalib.errors import RecalibError
from recalib.storage import whole
from recalib.study.recording.acts import AFTER, BEFORE
from recalib.study.recording.viewer import PROGRAM, quiet

WINDOW = 1400, 800  # pixels
TOP_BAR = 37  # pixels of it: the window's own bar, which shows nothing of the recording
PATIENCE = 60.0  # seconds for the viewer to start and to load, in software on a busy machine
REPAINTS = 40  # until the viewer's notices have gone: they count repaints, not seconds


class ViewerUnavailable(RecalibError):
    """The viewer does not run here, most often for want of a Vulkan driver."""


def before_and_after(recording: Path, before: Path, after: Path) -> None:
    """Pictures of the arm before and after its recalibration; see `take_pictures`."""
    take_pictures(recording, {before: BEFORE, after: AFTER})


def take_pictures(
    recording: Path,
    pictures: Mapping[Path, float],
    view: str | None = None,
    window: tuple[int, int] = WINDOW,
) -> None:
    """Write what the viewer shows of a recording, one PNG for each second of its timeline `time`.

    Args:
        recording: the file.
        pictures: the second that each shows.
        view: name of the one that is shown, such as `acts.ARM`; all that the window shows
            unless given. In a smaller window, words are larger beside the rest.
        window: its size in pixels.

    Needs a Vulkan driver; one in software will do, such as Debian's mesa-vulkan-drivers.
    Raises ViewerUnavailable where the viewer does not start or does not load the recording.
    """
    with _viewer(window) as viewer:
        _load(viewer, recording)
        for repaint in range(REPAINTS):
            _show(viewer, repaint / 100)
        shown = {each.name: each.view_id for each in viewer.get_state().views}
        for png, seconds in pictures.items():
            _show(viewer, seconds)
            with whole(png) as temporary:
                viewer.save_screenshot(str(temporary.resolve()), shown[view] if view else None)
                _save(temporary, 0 if view else TOP_BAR)


@contextmanager
def _viewer(window: tuple[int, int]) -> Iterator[ViewerClient]:
    """A viewer without a screen. `ViewerClient.spawn` would listen to the whole network."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    size = f"{window[0]}x{window[1]}"
    options = [
        "--headless",
        "--hide-welcome-screen",
        "--bind",
        "127.0.0.1",
        "--port",
        str(port),
        "--window-size",
        size,
    ]
    with tempfile.TemporaryFile("w+", encoding="utf-8") as log:
        process = subprocess.Popen([PROGRAM, *options], env=quiet(), stdout=log, stderr=log)
        try:
            deadline = time.monotonic() + PATIENCE
            while (client := _connect(port)) is None:
                if process.poll() is not None or time.monotonic() > deadline:
                    raise ConnectionError
                time.sleep(0.1)
            yield client
        except (ConnectionError, RuntimeError):  # it also ends later, where it first has to draw
            log.seek(0)
            reason = next((line.strip() for line in log if "panicked" in line), "no answer")
            raise ViewerUnavailable(
                f"the viewer does not run here ({reason}); it needs a Vulkan driver,"
                " such as Debian's mesa-vulkan-drivers"
            ) from None
        finally:
            process.terminate()
            process.wait()


def _connect(port: int) -> ViewerClient | None:
    try:
        client = ViewerClient(f"rerun+http://127.0.0.1:{port}/proxy")
        client.get_state()
    except (ConnectionError, RuntimeError):
        return None
    return client


def _load(viewer: ViewerClient, recording: Path) -> None:
    viewer.open(str(recording.resolve()))
    deadline = time.monotonic() + PATIENCE
    while (state := viewer.get_state()).loading or not state.recordings:
        if time.monotonic() > deadline:
            raise ViewerUnavailable(f"the viewer did not load {recording} within {PATIENCE:.0f} s")
        time.sleep(0.1)


def _show(viewer: ViewerClient, seconds: float) -> None:
    viewer.set_time("time", duration=seconds, play_state="paused")
    time.sleep(0.05)


def _save(png: Path, top: int) -> None:
    """Cut the top off, and keep 256 colours: a third of the bytes, the same to the eye."""
    with Image.open(png) as image:
        picture = image.convert("RGB").crop((0, top, *image.size))
    picture.quantize(256, dither=Image.Dither.NONE).save(png, optimize=True)
