"""Recordings and report in a browser: `python -m workflow.watch FOLDER [--port PORT]`.

All of it stays on this machine: the browser itself is told to ask for nothing elsewhere.
"""

import argparse
import getpass
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from recalib.errors import RecalibError
from recalib.laboratory.viewer.process import HERE
from recalib.study.configuration.shipped import RESULTS, SHIPPED
from recalib.study.evidence.pages.report import layout
from recalib.study.recording.naming import in_words
from recalib.study.recording.web_viewer import copy_viewer
from recalib.study.scenarios.plants import Resolved

TEMPLATE = Path(__file__).with_name("watch.html.j2")
FIGURES = Path(__file__).resolve().parents[1] / "figures"  # the committed ones
# The viewer is WebAssembly, which counts as eval.
POLICY = "default-src 'self' data: blob: 'unsafe-inline' 'unsafe-eval'"


@contextmanager
def site(folder: Path, port: int = 0) -> Iterator[ThreadingHTTPServer]:
    """A server of a folder of results and of a viewer for browsers, on any free port if 0.

    Raises RecalibError where nothing is recorded, or where another program has the port.
    """
    recordings = sorted((folder / "recordings").glob("*.rrd"))
    if not recordings:
        raise RecalibError(f"no recording in {folder / 'recordings'}; `make quick` makes some")
    with TemporaryDirectory() as temporary:
        root = Path(temporary)
        (root / "results").symlink_to(folder.resolve())
        (root / "figures").symlink_to(FIGURES)
        copy_viewer(root / "viewer")
        shipped = folder.name == RESULTS
        shown = [_shown(path, root) for path in recordings]
        arms = ["results/figures/arm_before.png", *["figures/arm_before.png"] * shipped]
        known = {
            "study": SHIPPED if shipped else folder.name,
            "arm": next((arm for arm in arms if (root / arm).exists()), ""),
            "recordings": sorted(shown, key=lambda its: not its["picture"]),
            "report": (folder / "report.html").exists(),
        }
        template = layout().from_string(TEMPLATE.read_text(encoding="utf-8"))
        (root / "index.html").write_text(template.render(known), encoding="utf-8")
        try:
            server = ThreadingHTTPServer((HERE, port), partial(_Handler, directory=temporary))
        except OSError:
            another = f"try another one, such as PORT={port + 1}"
            raise RecalibError(f"port {port} is taken; {another}") from None
        with server:
            yield server


def _shown(recording: Path, root: Path) -> dict[str, Any]:
    """What the page shows of a recording: its name, its damages in words, a picture if any."""
    name = recording.stem
    scenario = recording.parents[1] / "scenarios" / f"{name}.json"
    words = ""
    if scenario.exists():
        damages = Resolved.read(scenario).damages
        words = "; ".join(map(in_words, damages)) or "nothing is wrong with this arm"
    picture = f"results/figures/{name}_before.png"
    return {"name": name, "damages": words, "picture": picture if (root / picture).exists() else ""}


class _Handler(SimpleHTTPRequestHandler):
    """Files, to be asked for anew each time, on a page that asks for nothing elsewhere."""

    def end_headers(self):
        self.send_header("Content-Security-Policy", POLICY)
        self.send_header("Cache-Control", "no-store")
        super().end_headers()

    def log_message(self, *args):
        """Say nothing of each request."""


def main(arguments: list[str] | None = None) -> None:
    """Serve a folder of results until interrupted. An error of recalib is shown as a line."""
    parser = argparse.ArgumentParser(prog="watch", description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--port", type=int, default=9090)
    chosen = parser.parse_args(arguments)
    try:
        with site(chosen.folder, chosen.port) as server:
            print(f"Recordings and report: http://{HERE}:{chosen.port}/ (Ctrl-C ends it)")
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
