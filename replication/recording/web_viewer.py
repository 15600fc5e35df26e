"""The viewer for browsers, as files of a page: it asks for nothing elsewhere."""

import base64
import gzip
import json
import re
from functools import partial
from pathlib import Path
from urllib.request import urlopen

from replication.recording.viewer import HERE, answer, free_port, viewer

PAGE, PROGRAM = "index.html", "re_viewer_bg.wasm"
ELSEWHERE = re.compile(r"<link[^>]*https://[^>]*>")  # fonts of the viewer's page
# It tells its makers of its use and asks for news, which it has no setting for in a browser: what
# is elsewhere answers at once, with nothing. On a disk a page may read scripts alone, so these can
# bring files along.
HEAD = """<head><script>
const fetched = window.fetch, packed = {};
window.fetch = async (asked, how) => {
  const address = new URL(asked.url ?? asked, location);
  const brought = packed[address.pathname.split("/").pop()];
  if (brought) {
    const bytes = Uint8Array.from(atob(brought), letter => letter.charCodeAt());
    return new Response(
      new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip")));
  }
  return address.origin === location.origin
    ? fetched(asked, how) : new Response(null, {status: 204});
};
</script>"""
NAME = "recording.rrd"
# The whole address that the viewer wants, though nothing is there.
ADDRESS = f"{PAGE}?persist=false&theme=dark&hide_welcome_screen&url=https://packed/{NAME}"


def copy_viewer(folder: Path) -> None:
    """Put it into a new folder, for a server: `index.html?url=` opens a recording.

    Its files are part of the viewer's program, which serves them. Raises ConnectionError where that
    does not start.
    """
    folder.mkdir()
    port = free_port()
    # with an address to show it starts no other server, which would take a core all the time
    with viewer("--serve-web", "--web-viewer-port", port, f"http://{HERE}/_.rrd") as process:
        for name in (PAGE, "re_viewer.js", PROGRAM, "favicon.ico"):
            fetch = partial(_fetch, f"http://{HERE}:{port}/{name}")
            (folder / name).write_bytes(answer(process, fetch))
    page = folder / PAGE
    text = ELSEWHERE.sub("", page.read_text(encoding="utf-8"))
    page.write_text(text.replace("<head>", HEAD, 1), encoding="utf-8")


def embed(recording: Path, folder: Path) -> None:
    """Put it into a new folder with a recording, for a disk or a server: `ADDRESS` opens that.

    Raises ConnectionError as `copy_viewer`.
    """
    copy_viewer(folder)
    program = folder / PROGRAM
    for name, content in ((PROGRAM, program.read_bytes()), (NAME, recording.read_bytes())):
        text = base64.b64encode(gzip.compress(content, mtime=0)).decode()
        script = f"packed[{json.dumps(name)}] = {json.dumps(text)};\n"
        (folder / f"{name}.js").write_text(script, encoding="utf-8")
    program.unlink()
    scripts = "".join(f'<script src="{name}.js"></script>' for name in (PROGRAM, NAME))
    page = folder / PAGE
    page.write_text(page.read_text("utf-8").replace(HEAD, HEAD + scripts), encoding="utf-8")


def _fetch(address: str) -> bytes:
    with urlopen(address) as page:
        return page.read()
