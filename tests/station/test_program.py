"""Stations behind programs, and what may stand on the command line."""

import json
import runpy
import shutil
import sys
import time

import numpy as np
import pytest

import recalib
from recalib.laboratory.command_line import DONE, main
from recalib.station import open_station
from tests.conftest import ROOT, few_folds

DESCRIBED = {"joints": ["a", "b"], "lower": [-1, -1], "upper": [1, 1]}
PROGRAM = """
import json, sys
answers = json.loads({answers!r})
for line in sys.stdin:
    request = json.loads(line)
    print(line, file=open("heard", "a"), end="")
    if request["do"] in answers:
        print(answers[request["do"]], flush=True)
    elif request["do"] != "stop":
        sys.exit()
print("ended", file=open("heard", "a"))
"""
ANSWERS = {
    "describe": json.dumps(DESCRIBED),
    "move": "{}",
    "angles": '{"angles": [0.1, 0.2]}',
    "measure": '{"row": {"x [m]": 0.5, "target": "ball"}}',
}


@pytest.fixture
def program(tmp_path, monkeypatch):
    """Starts a program that answers so; a request that has no answer ends it."""
    monkeypatch.chdir(tmp_path)
    stations = []

    def start(**answers):
        text = PROGRAM.format(answers=json.dumps(ANSWERS | answers))
        stations.append(recalib.ProgramStation([sys.executable, "-c", text]))
        return stations[-1]

    yield start
    for station in stations:
        station.close()


def test_each_request_is_a_line_and_so_is_its_answer(program, tmp_path):
    station = program()
    assert list(station.joints) == ["a", "b"]
    assert tuple(station.limits) == ([-1, -1], [1, 1])
    station.move(recalib.load_arm("ur10_robot.urdf", "tool0").model.upperPositionLimit[:2], 0.2)
    assert station.angles() == [0.1, 0.2]
    assert station.measure() == {"x [m]": 0.5, "target": "ball"}
    station.stop()
    station.close()
    station.stop()  # at any time
    *heard, last = (tmp_path / "heard").read_text().splitlines()
    assert [json.loads(line)["do"] for line in heard] == [*ANSWERS, "stop"]
    assert json.loads(heard[1])["speed"] == 0.2 and last == "ended"


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        ("[INFO] measuring", "answered '.INFO. measuring' to 'measure'; expected: a JSON object"),
        ("[1, 2]", "expected: a JSON object on one line. Log messages belong on stderr"),
        ("[" * 100_000, "expected: a JSON object"),
        ("{}", "answered 'measure' without 'row'"),
    ],
)
def test_an_answer_that_is_none_is_told(program, answer, message):
    with pytest.raises(recalib.StationFailed, match=message):
        program(measure=answer).measure()


def test_an_error_may_be_the_answer_to_each_request(program):
    station = program(**dict.fromkeys(("move", "angles", "measure"), '{"error": "a collision"}'))
    for ask in (lambda: station.move(np.zeros(2), 0.1), station.angles, station.measure):
        with pytest.raises(recalib.StationFailed, match="python.*: a collision"):
            ask()


def test_a_program_that_ends_is_told_and_one_that_does_not_is_ended(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = PROGRAM.format(answers=json.dumps({"describe": json.dumps(DESCRIBED)}))
    station = recalib.ProgramStation([sys.executable, "-c", text])
    for _ in range(2):
        with pytest.raises(recalib.StationFailed, match="ended before it answered 'angles'"):
            station.angles()
    station.stop()
    station.close()
    monkeypatch.setattr("recalib.station.opening.PATIENCE", 0.1)
    text = f"import time; print({json.dumps(DESCRIBED)!r}, flush=True); time.sleep(60)"
    station, start = recalib.ProgramStation([sys.executable, "-c", text]), time.monotonic()
    station.close()
    assert time.monotonic() - start < 30


@pytest.mark.skipif(not shutil.which("node"), reason="needs node")
def test_the_example_in_another_language_is_a_station(tmp_path, monkeypatch):
    monkeypatch.setattr("recalib.station.guarded.PATIENCE", 60)  # s: Node starts slowly
    arm, answers = recalib.load_arm("ur10_robot.urdf", "tool0"), iter([recalib.Answer.MOVE] * 10)
    program = f"node {ROOT / 'examples' / 'station.js'}"
    end = recalib.calibrate_live(
        lambda: open_station(program),
        arm,
        tmp_path / "rows.csv",
        recalib.LiveSettings(),
        lambda move: next(answers, recalib.Answer.END),
    )
    assert end == ("you ended it", 11)


@pytest.mark.slow  # a whole session
def test_the_example_in_python_is_a_station(tmp_path, capsys):
    """By the command, with a floor and all."""
    example = ROOT / "examples" / "station.py"
    out = f"--table={tmp_path}/rows.csv", f"--out={tmp_path}/new"
    with few_folds():
        words = [f"{example}:BentUR10", "ur10_robot.urdf", "--tool=tool0", "--yes", *out]
        assert main(["live", *words]) == DONE
    assert "more rows would reduce it by less than 5 %" in capsys.readouterr().err
    station = runpy.run_path(str(example))["BentUR10"]()
    fresh = station.angles() + np.random.default_rng(0).uniform(-0.7, 0.7, (50, 6))
    found = recalib.load_correction(tmp_path / "new" / "correction.npz").calibration.predict(fresh)
    gaps = found[:, :3, 3] - [station.position_at(angles) for angles in fresh]
    assert np.linalg.norm(gaps, axis=1).mean() < 5e-4


def test_a_file_imports_its_neighbours(tmp_path):
    (tmp_path / "driver_of_mine.py").write_text("SPEED = 3")
    (tmp_path / "mine.py").write_text("import driver_of_mine\nStation = driver_of_mine.__class__")
    with pytest.raises(recalib.StationFailed, match=r"mine.py:Station cannot be made: TypeError"):
        open_station(f"{tmp_path / 'mine.py'}:Station")
