"""Recordings and report, looked at: in the viewer's window, or in a browser where there is none.

`python -m workflow.watch view FILE.rrd` and `python -m workflow.watch web FOLDER`. All of
it stays on this machine: the browser itself is told to ask for nothing elsewhere.
"""

import argparse
import getpass
import os
import re
import socket
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from tempfile import TemporaryDirectory
from urllib.error import URLError
from urllib.request import urlopen

import jinja2

from recalib.errors import RecalibError
from recalib.study.recording.viewer import PROGRAM, quiet
from recalib.study.shipped import RESULTS, SHIPPED

HERE = "127.0.0.1"
PORT = 9090
TEMPLATE = Path(__file__).with_name("watch.html.j2")
VIEWER = ("index.html", "re_viewer.js", "re_viewer_bg.wasm", "favicon.ico")
ELSEWHERE = re.compile(r"<link[^>]*https://[^>]*>")  # fonts of the viewer's page
# It tells its makers of its use and asks for news, which it has no setting for in a browser: what
# is elsewhere answers at once, with nothing.
QUIET = """<head><script>
const fetched = window.fetch;
window.fetch = (asked, how) =>
  new URL(asked.url ?? asked, location).origin === location.origin
    ? fetched(asked, how)
    : Promise.resolve(new Response(null, {status: 204}));
</script>"""
# The viewer is WebAssembly, which counts as eval.
POLICY = "default-src 'self' data: blob: 'unsafe-inline' 'unsafe-eval'"
PATIENCE = 30.0  # seconds for the viewer's own server to start


class NoDisplay(RecalibError):
    """There is no screen for a window."""

    def __init__(self):
        super().__init__("no display for a window here; `make web` shows the same in a browser")


class NothingToShow(RecalibError):
    """A folder of results without recordings."""

    def __init__(self, folder: Path):
        super().__init__(f"no recording in {folder / 'recordings'}; `make quick` makes some")


class PortTaken(RecalibError):
    """Another program listens there."""

    def __init__(self, port: int):
        super().__init__(f"port {port} is taken; valid: another one, such as PORT={port + 1}")


def view(recording: Path) -> None:
    """Open the viewer's window. Raises NoDisplay."""
    if sys.platform == "linux" and not {"DISPLAY", "WAYLAND_DISPLAY"} & {*os.environ}:
        raise NoDisplay
    with _viewer("--bind", HERE, "--new", recording) as viewer:
        viewer.wait()


def web(folder: Path, port: int = PORT) -> None:
    """Serve the recordings and the report of a folder of results until interrupted.

    Raises NothingToShow, PortTaken.
    """
    with site(folder, port) as server:
        print(f"Recordings and report: http://{HERE}:{port}/ (Ctrl-C ends it)")
        there = f"ssh -L {port}:{HERE}:{port} {getpass.getuser()}@{socket.gethostname()}"
        print(f"From another machine: {there}, then the same address", flush=True)
        try:
            server.serve_forever()
        except KeyboardInterrupt:
            print()


@contextmanager
def site(folder: Path, port: int = 0) -> Iterator[ThreadingHTTPServer]:
    """A server of a folder of results and of a viewer for browsers, on any free port if 0."""
    recordings = sorted(path.name for path in (folder / "recordings").glob("*.rrd"))
    if not recordings:
        raise NothingToShow(folder)
    with TemporaryDirectory() as temporary:
        root = Path(temporary)
        (root / "results").symlink_to(folder.resolve())
        _copy_viewer(root / "viewer")
        study = SHIPPED if folder.name == RESULTS else folder.name
        known = {"study": study, "recordings": recordings}
        known["report"] = (folder / "report.html").exists()
        template = jinja2.Template(TEMPLATE.read_text(encoding="utf-8"), autoescape=True)
        (root / "index.html").write_text(template.render(known), encoding="utf-8")
        try:
            server = ThreadingHTTPServer((HERE, port), partial(_Handler, directory=temporary))
        except OSError:
            raise PortTaken(port) from None
        with server:
            yield server


class _Handler(SimpleHTTPRequestHandler):
    """Files, to be asked for anew each time, on a page that asks for nothing elsewhere."""

    def end_headers(self):
        self.send_header("Content-Security-Policy", POLICY)
        self.send_header("Cache-Control", "no-store")
        super().end_headers()

    def log_message(self, *args):
        """Say nothing of each request."""


def _copy_viewer(folder: Path) -> None:
    """The viewer's files: they are part of its program, which serves them."""
    with socket.socket() as free:
        free.bind((HERE, 0))
        port = free.getsockname()[1]
    folder.mkdir()
    # with an address to show it starts no other server, which would take a core all the time
    options = "--serve-web", "--bind", HERE, "--web-viewer-port", str(port), f"http://{HERE}/_.rrd"
    with _viewer(*options) as viewer:
        for name in VIEWER:
            (folder / name).write_bytes(_fetched(f"http://{HERE}:{port}/{name}", viewer))
    page = folder / "index.html"
    text = ELSEWHERE.sub("", page.read_text(encoding="utf-8"))
    page.write_text(text.replace("<head>", QUIET, 1), encoding="utf-8")


def _fetched(address: str, viewer: subprocess.Popen) -> bytes:
    deadline = time.monotonic() + PATIENCE
    while True:
        try:
            with urlopen(address) as answer:
                return answer.read()
        except URLError:
            if viewer.poll() is not None or time.monotonic() > deadline:
                raise
            time.sleep(0.05)


@contextmanager
def _viewer(*options: str | Path) -> Iterator[subprocess.Popen]:
    """The viewer's program; ended at the end of the block."""
    process = subprocess.Popen(
        [PROGRAM, *options],
        env=quiet(),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        yield process
    finally:
        process.terminate()
        process.wait()


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line. An error of recalib is shown as a line."""
    parser = argparse.ArgumentParser(prog="watch", description=__doc__.split("\n")[0])
    kinds = parser.add_subparsers(dest="how", required=True)
    kinds.add_parser("view").add_argument("recording", type=Path)
    its = kinds.add_parser("web")
    its.add_argument("folder", type=Path)
    its.add_argument("--port", type=int, default=PORT)
    chosen = vars(parser.parse_args(arguments))
    try:
        {"view": view, "web": web}[chosen.pop("how")](**chosen)
    except RecalibError as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
