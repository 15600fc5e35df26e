"""The viewer's program leaves nothing in a home, and is started in one way alone."""

import subprocess
from pathlib import Path

from recalib.study.recording.viewer import PROGRAM, quiet
from tests.conftest import ROOT
from tests.test_architecture import imported


def test_it_writes_nothing_into_a_home(tmp_path):
    """As it does otherwise, with leave to tell its makers of its use."""
    home = {"HOME": str(tmp_path), "XDG_CONFIG_HOME": str(tmp_path / "c")}
    home |= {"XDG_DATA_HOME": str(tmp_path / "d"), "XDG_CACHE_HOME": str(tmp_path / "e")}
    verify = [PROGRAM, "rrd", "verify", tmp_path / "none.rrd"]
    subprocess.run(verify, env=quiet() | home, capture_output=True)
    assert list(tmp_path.iterdir()) == []
    otherwise = {name: value for name, value in (quiet() | home).items() if name != "CI"}
    subprocess.run(verify, env=otherwise, capture_output=True)
    assert list(tmp_path.iterdir()), "it is quiet by itself: this test shows nothing"


def test_nothing_else_starts_it():
    files = [
        path for part in ("recalib", "workflow", "tests") for path in (ROOT / part).rglob("*.py")
    ]
    starting = {path for path in files if "rerun_cli" in imported(path)}
    assert starting == {Path(ROOT, "recalib", "study", "recording", "viewer.py")}
