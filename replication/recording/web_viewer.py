"""The viewer for browsers with a recording, as files of a page that needs no other server.

`python -m replication.recording.web_viewer RECORDING FOLDER` writes them.
"""

import base64
import gzip
import json
import re
import sys
from functools import partial
from pathlib import Path
from urllib.request import urlopen

from replication.recording.viewer import HERE, answer, free_port, viewer

PAGE, PROGRAM, RECORDING = "index.html", "re_viewer_bg.wasm", "recording.rrd"
ELSEWHERE = re.compile(r"<link[^>]*https://[^>]*>")  # links to fonts in the viewer's page
# The page opens its recording. The viewer needs a complete URL, so this one is fictitious. In a
# browser the viewer has no setting against usage data and checks for news: the script answers all
# requests to other servers at once, with nothing. A page on a disk may only load scripts, so files
# are packed into scripts.
HEAD = f"""<head><script>
if (!location.search)
  location.replace("?persist=false&theme=dark&hide_welcome_screen&url=https://packed/{RECORDING}");
const fetched = window.fetch, packed = {{}};
window.fetch = async (asked, how) => {{
  const address = new URL(asked.url ?? asked, location);
  const brought = packed[address.pathname.split("/").pop()];
  if (brought) {{
    const bytes = Uint8Array.from(atob(brought), letter => letter.charCodeAt());
    return new Response(
      new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip")));
  }}
  return address.origin === location.origin
    ? fetched(asked, how) : new Response(null, {{status: 204}});
}};
</script><script src="{PROGRAM}.js"></script><script src="{RECORDING}.js"></script>"""


def embed(recording: Path, folder: Path) -> None:
    """Write the viewer and a recording into a folder: `PAGE` opens it, from a disk or a server.

    The viewer's program contains these files and serves them. Raises ConnectionError if it does not
    start.
    """
    port = free_port()
    # given an address to show, it starts no second server, which would keep a core busy
    with viewer("--serve-web", "--web-viewer-port", port, f"http://{HERE}/_.rrd") as process:
        files = {
            name: answer(process, partial(_fetch, f"http://{HERE}:{port}/{name}"))
            for name in (PAGE, "re_viewer.js", PROGRAM, "favicon.ico")
        }
    for name, content in ((PROGRAM, files.pop(PROGRAM)), (RECORDING, recording.read_bytes())):
        text = base64.b64encode(gzip.compress(content, mtime=0)).decode()
        files[f"{name}.js"] = f"packed[{json.dumps(name)}] = {json.dumps(text)};\n".encode()
    page = ELSEWHERE.sub("", files[PAGE].decode("utf-8"))
    files[PAGE] = page.replace("<head>", HEAD, 1).encode()
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (folder / name).write_bytes(content)


def _fetch(address: str) -> bytes:
    with urlopen(address) as page:
        return page.read()


if __name__ == "__main__":
    embed(*map(Path, sys.argv[1:]))
