"""A mistake on the command line is refused in one sentence, and nothing is written."""

import re
import shlex
import shutil

import pytest
import yaml

from recalib.laboratory.command_line import REFUSED, main
from tests.conftest import ROOT
from tests.laboratory.conftest import postures, table, true_positions, write

TABLE = yaml.safe_load((ROOT / "tests" / "mistakes_on_the_command_line.yaml").read_text())
KNOWN = {"{joints}": "swing [deg],lift [deg],elbow [deg]", "{row}": "1,-40,60,700,10,300"}


@pytest.fixture(scope="module")
def right(arm, calibrated, tmp_path_factory):
    """A folder with an arm, a table and a calibration."""
    here, joints = tmp_path_factory.mktemp("right"), postures(8, 12)
    shutil.copy(calibrated.parent / "arm.urdf", here)
    shutil.copytree(calibrated, here / "calibration")
    write(here / "table.csv", table(arm, joints, true_positions(arm, joints)))
    return here


def messages_of(row, folder, capfd) -> list[str]:
    """Lines on stderr, also those of compiled code, without progress and usage."""
    lines = "\n".join(row.get("lines", ()))
    for name, text in KNOWN.items():
        lines = lines.replace(name, text)
    if "file" in row:
        (folder / row["file"]).write_text(lines, encoding="utf-8")
    words = shlex.split(row["line"])
    if words[:1] in (["calibrate"], ["urdf"]) and "--out" not in words:
        words += ["--out", "new"]  # what it would write is there already
    try:
        code = main(words)
    except SystemExit as stopped:  # argparse's
        code = stopped.code
    assert code == REFUSED
    lines = capfd.readouterr().err.splitlines()
    return [line for line in lines if not line.startswith("... ")]


@pytest.mark.parametrize("row", TABLE, ids=[row["why"] for row in TABLE])
def test_a_mistake_is_told_in_one_sentence(row, right, tmp_path, monkeypatch, capfd):
    if row["line"].startswith(("board ", "observe ")):
        pytest.importorskip("cv2", reason="needs OpenCV, of the extra vision")
    here = shutil.copytree(right, tmp_path / "here")
    monkeypatch.chdir(here)
    (message,) = messages_of(row, here, capfd)
    expected = map(re.escape, row["says"].split("..."))
    assert re.fullmatch(".*".join(expected), message), message
    written = {path.name for path in here.iterdir()} - {row.get("file")}
    assert written == {path.name for path in right.iterdir()}
