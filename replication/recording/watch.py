"""Recordings in a browser: `python -m replication.recording.watch FOLDER [--port PORT]`.

All of it stays on this machine: the browser itself is told to ask for nothing elsewhere.
"""

import argparse
import getpass
import socket
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import jinja2

from recalib.errors import RecalibError
from replication.recording.viewer import HERE
from replication.recording.web_viewer import copy_viewer

TEMPLATE = Path(__file__).resolve().parents[2] / "workflow" / "templates" / "watch.html.j2"
# The viewer is WebAssembly, which counts as eval.
POLICY = "default-src 'self' data: blob: 'unsafe-inline' 'unsafe-eval'"


@contextmanager
def site(folder: Path, port: int = 0) -> Iterator[ThreadingHTTPServer]:
    """A server of the recordings in a folder of results and of a viewer for browsers.

    Args:
        port: any free one if 0.

    Raises RecalibError: nothing is recorded, or another program has the port.
    """
    recordings = (folder / "recordings").resolve()
    names = sorted(path.stem for path in recordings.glob("*.rrd"))
    if not names:
        raise RecalibError(f"no recording in {folder / 'recordings'}; `make quick` makes some")
    with TemporaryDirectory() as temporary:
        root = Path(temporary)
        (root / "recordings").symlink_to(recordings)
        copy_viewer(root / "viewer")
        template = jinja2.Template(TEMPLATE.read_text(encoding="utf-8"), autoescape=True)
        page = template.render(names=names)
        (root / "index.html").write_text(page, encoding="utf-8")
        try:
            server = ThreadingHTTPServer((HERE, port), partial(_Handler, directory=temporary))
        except OSError:
            another = f"try another one, such as PORT={port + 1}"
            raise RecalibError(f"port {port} is taken; {another}") from None
        with server:
            yield server


class _Handler(SimpleHTTPRequestHandler):
    """Files, to be asked for anew each time, on a page that asks for nothing elsewhere."""

    def end_headers(self) -> None:
        self.send_header("Content-Security-Policy", POLICY)
        self.send_header("Cache-Control", "no-store")
        super().end_headers()

    def log_message(self, *_: Any) -> None:
        """Say nothing of each request."""


def main(arguments: Sequence[str] | None = None) -> None:
    """Serve a folder of results until interrupted. An error of recalib is shown as a line."""
    parser = argparse.ArgumentParser(prog="watch", description="Show recordings in a browser.")
    parser.add_argument("folder", type=Path, help="of a study's results")
    parser.add_argument("--port", type=int, default=9090)
    chosen = parser.parse_args(arguments)
    try:
        with site(chosen.folder, chosen.port) as server:
            print(f"Recordings: http://{HERE}:{chosen.port}/ (Ctrl-C ends it)")
            there = f"ssh -L {chosen.port}:{HERE}:{chosen.port}"
            there += f" {getpass.getuser()}@{socket.gethostname()}"
            print(f"From another machine: {there}, then the same address", flush=True)
            server.serve_forever()
    except KeyboardInterrupt:
        print()
    except RecalibError as error:
        sys.exit(str(error))


if __name__ == "__main__":
    main()
