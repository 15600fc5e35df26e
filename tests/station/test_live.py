"""A calibration that moves the arm itself: where it ends, and what stops it."""

import os
import random
import re
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
import rerun as rr

from recalib.errors import InvalidFile, InvalidSetting, UnknownName
from recalib.identification.model.observations import Observations
from recalib.laboratory.calibrate import calibrate_arm
from recalib.laboratory.command_line import DONE, REFUSED, main
from recalib.laboratory.correction.correct import NotReached
from recalib.laboratory.correction.corrector import Corrector
from recalib.laboratory.live import calibration as live
from recalib.laboratory.live import running
from recalib.laboratory.live.allowed import AllowedPostures, Box
from recalib.laboratory.live.calibration import Interrupted, LiveSettings, calibrate_live
from recalib.laboratory.live.running import PredictedError
from recalib.laboratory.live.view import LiveView
from recalib.laboratory.tables.description import Description
from recalib.nominal.descriptions import find_urdf
from recalib.station.guarded import Guarded
from recalib.station.interface import StationFailed
from tests.conftest import ROOT, few_folds
from tests.identification.real import ARMS
from tests.kept import plain
from tests.logged import logged
from tests.station.simulated import HOMES, Simulated, Spoilt

YES = lambda posture: True  # noqa: E731
AROUND = Box(np.array([-2.0, -2.0, 0.1]), np.array([2.0, 2.0, 2.0]))


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """Waits are short, and what follows from the same rows is found once."""
    monkeypatch.setattr("recalib.station.guarded.APART", 0.001)
    monkeypatch.setattr("recalib.station.guarded.SETTLING", 0.1)
    for find, rows in ((running.checked_frames, 1), (running.most_probable, 2)):
        monkeypatch.setattr(running, find.__name__, partial(once, find, rows))


FOUND = {}


def once(find, place, *given):
    """What a function finds, by the rows among its arguments."""
    rows = given[place]
    key = find, rows.joints.tobytes(), rows.measured.tobytes()
    if key not in FOUND:
        FOUND[key] = find(*given)
    return FOUND[key]


def run(station, tmp_path, ask=YES, on_progress=lambda line: None, **settings):
    watch = {name: settings.pop(name) for name in ("on_row",) if name in settings}
    settings = LiveSettings(**({"patience": 1.0} | settings))
    table = tmp_path / "table.csv"
    its = lambda: station  # noqa: E731
    return calibrate_live(its, station.arm, table, settings, ask, None, on_progress, **watch)


@pytest.mark.parametrize(("name", "seed"), [*zip(ARMS, (1, 2), strict=True)])
def test_it_ends_by_itself_and_the_arm_is_calibrated(name, seed, tmp_path):
    station = Simulated(name, seed, noise=(5e-5, np.radians(0.01)))
    reason = run(station, tmp_path, error=3e-4)
    assert "0.3 mm was asked for" in reason
    assert station.calls.count("move") < 30 and "stop" not in station.calls
    urdf, tool = ARMS[name]
    with few_folds():
        result = calibrate_arm(urdf, tmp_path / "table.csv", tool=tool)
    low, high = (np.array(HOMES[name]) + side * np.radians(45) for side in (-1, 1))
    fresh = np.random.default_rng(seed).uniform(low, high, (200, len(low)))
    gaps = result.calibration.predict(fresh) - station.real.poses(fresh, noise=(0, 0))
    assert np.linalg.norm(gaps[:, :3, 3], axis=1).mean() < 3e-4


def test_it_ends_where_more_is_of_no_use(tmp_path):
    assert "would hardly make it smaller" in run(Simulated(), tmp_path)


def test_it_ends_where_it_is_told_to(tmp_path):
    expected = "the predicted error is not known yet; 10 rows are as many as allowed"
    assert run(Simulated(), tmp_path, most=10) == expected


def test_errors_are_said_in_millimetres():
    its, told = SimpleNamespace(is_ready=bool, is_settled=lambda rows: False), []
    rows = Observations(np.zeros((1, 6)))
    its.error = lambda rows: PredictedError(by_model=0.999, by_rows=0.888)
    assert live._enough(rows, its, [], LiveSettings(), told.append) is None
    assert told == ["row 1: predicted error by the model 999 mm, by the last rows 888 mm"]


@pytest.mark.parametrize("count", [4, 25], ids=["without", "with a calibration"])
def test_postures_are_proposed_on_the_side_where_the_target_was_seen(count):
    its = Simulated()
    home, joints = its.stands, its.arm.joints
    postures = AllowedPostures(its.arm, home, its.limits, np.radians(45), None)
    proposing = running.RunningCalibration(its.arm, Description(), postures)
    seen = postures.joints[postures.joints[:, 0] < home[0]][:count]
    unseen = [posture + 2 * (home[0] - posture[0]) * np.eye(len(joints))[0] for posture in seen]
    rows = Observations(seen, its.real.poses(seen, noise=its.noise))
    assert proposing.next_posture(rows, [])[0] > home[0]
    assert proposing.next_posture(rows, unseen)[0] <= home[0]
    everywhere = [posture + 0.05 for posture in postures.joints]
    assert proposing.next_posture(rows, everywhere) is not None


def test_the_more_postures_are_without_a_sight_the_nearer_is_the_next():
    its = Simulated()
    postures = AllowedPostures(its.arm, its.stands, its.limits, np.radians(45), None)
    proposing = running.RunningCalibration(its.arm, Description(), postures)
    rows = Observations(its.stands[None], its.real.poses(its.stands[None], noise=its.noise))
    gaps, unseen = [], []
    for _ in range(9):
        goal = proposing.next_posture(rows, unseen)
        unseen.append(goal)
        gaps.append(np.linalg.norm(goal - its.stands))
    assert max(gaps[4:]) < 0.7 * gaps[0]


@pytest.mark.parametrize("error", [0.0, -1e-3, np.inf, np.nan])
def test_no_calibration_goes_by_impossible_settings(error):
    for wrong in (
        {"error": error},
        {"span": error},
        {"patience": error},
        {"speed": error},
        {"most": 9},
    ):
        (name,) = wrong
        with pytest.raises(InvalidSetting, match=f"^{name} is "):
            LiveSettings(**wrong)


def test_a_station_that_does_not_open_leaves_no_rows_to_go_on_with(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(LINE.format("Unheard").split()) == REFUSED
    assert "rows are in" not in capsys.readouterr().err


def raising(error):
    raise error


def moved(its) -> int:
    return its.calls.count("move")


def measured(its) -> int:
    return its.calls.count("measure")


def stuck(its, cells):
    """It says that it is where it was sent, but after nine moves it moves no more."""
    its.last = cells if moved(its) <= 9 else its.last
    return its.last


PROTECTIVE = "the protective stop of the arm is on"
STOPPED = {  # of what a station does, by what is said of it
    PROTECTIVE: {"moved": lambda its: raising(StationFailed(PROTECTIVE))},
    "for 1 s the station has not answered when asked to move": {"moved": lambda its: time.sleep(3)},
    "after a move, elbow_joint stands 0.05 rad or m from where it was sent": {
        "moved": lambda its: its.shift(0, 0, 0.05, 0, 0, 0)
    },
    "the arm still moves, 0.1 s after it should stand": {
        "told": lambda its, angles: its.shift(0.002) if moved(its) == 3 else angles
    },
    "the arm moved while it was measured": {
        "measured": lambda its, cells: cells if its.shift(0.01).any() else None
    },
    "asked to measure, the station raised KeyError: 'temperature'": {
        "measured": lambda its, cells: cells["temperature"]
    },
    "for 1 s the station has not answered when asked to measure": {
        "measured": lambda its, cells: time.sleep(3)
    },
    "no row: row 4 of column 'y' is 'nan'; expected: a number": {
        "measured": lambda its, cells: cells | {"y [m]": np.nan} if measured(its) == 4 else cells
    },
    "no row: its columns are .*, qw; the station gives .*, heat": {
        "measured": lambda its, cells: cells if measured(its) < 4 else cells | {"heat": 20.0}
    },
    "no row: no positions are measured in it; expected: x, y and z": {
        "measured": lambda its, cells: {"picture": "000.png"}
    },
    "the target was measured .* mm from where 1. rows put it; expected: about": {"measured": stuck},
    "not seen the target in 10 postures, .* try: a smaller --span": {
        "measured": lambda its, cells: cells if measured(its) < 2 else None
    },
    "does not see the target where the arm stands; try: begin where it does": {
        "measured": lambda its, cells: None
    },
    "the station's joints are joint_0, .*; expected: those of the arm": {
        "joints": [f"joint_{number}" for number in range(6)]
    },
    "asked to tell its limits, the station raised TypeError": {"limits": None},
    **{
        f"the station's angles are {said}": {"told": lambda its, angles, wrong=wrong: wrong}
        for said, wrong in (
            (r"\[0.0, .*, nan\]; expected: 6 finite numbers", [0.0] * 5 + [np.nan]),
            (r"\[0.0, .*\]; expected: 6 finite numbers", [0.0] * 7),
            ("'none'; expected: numbers", "none"),
            (r"\[inf, .*\]; expected: 6 finite numbers", [np.inf] * 6),
        )
    },
    "asked to tell its limits, the station raised ValueError": {"limits": [np.zeros(6)] * 3},
    "the station's lower limits are .*; expected: 6 finite numbers": {
        "limits": (np.full(6, -np.inf), np.full(6, 2.0))
    },
    "no row: 000.png is in an earlier row; expected: a new file for each picture": {
        "measured": lambda its, cells: cells | {"picture": "000.png"}
    },
    "no row: it has more than one column 'elbow_joint'": {
        "measured": lambda its, cells: cells | {"elbow_joint [rad]": 0.1}
    },
    "no row: unknown column '1'": {"measured": lambda its, cells: cells | {1: 2.0}},
    "limits of shoulder_pan_joint are the wrong way round": {
        "limits": (np.full(6, 2.0), np.full(6, -2.0))
    },
    "asked to tell its angles, the station raised OSError: no route": {
        "told": lambda its, angles: raising(OSError("no route")) if moved(its) == 3 else angles
    },
}


@pytest.mark.parametrize(("said", "what"), STOPPED.items(), ids=STOPPED)
def test_whatever_goes_wrong_it_stops_with_a_sentence_and_moves_no_more(said, what, tmp_path):
    station, told = Spoilt(**what), []
    with pytest.raises(StationFailed, match=said):
        run(station, tmp_path, on_progress=told.append)
    time.sleep(0.05)
    if "joints" not in what:  # it was never asked for anything
        assert station.calls.count("stop") == 1
        assert "move" not in station.calls[station.calls.index("stop") :]
        rows = measured(station) > 1
        assert bool(re.match(r"stopped; \d+ rows are in ", (told or [""])[-1])) == rows
    assert bool(len(told)) == (tmp_path / "table.csv").exists()


def test_joints_in_another_order_are_the_same_joints(tmp_path):
    class Reversed(Simulated):
        def __init__(self):
            super().__init__()
            self.joints = self.arm.joints[::-1]
            self.limits = [limit[::-1] for limit in self.limits]

        def move(self, angles, speed):
            super().move(angles[::-1], speed)

        def angles(self):
            return self.stands[::-1]

        def measure(self):  # also its cells are in another order, from the second row on
            cells = super().measure()
            return cells if measured(self) == 1 else dict(reversed(cells.items()))

    run(Reversed(), tmp_path, most=12)
    run(Simulated(), tmp_path / "..", most=12)
    tables = (tmp_path / "table.csv", tmp_path / ".." / "table.csv")
    assert tables[0].read_bytes() == tables[1].read_bytes()


def test_an_interrupt_stops_the_arm(tmp_path):
    station = Simulated()

    def ask(posture):
        if station.calls.count("move") == 4:
            raise KeyboardInterrupt
        return True

    with pytest.raises(Interrupted, match="the station was told to stop"):
        run(station, tmp_path, ask)
    assert station.calls[-1] == "stop"


def test_the_tool_stays_in_the_box_also_on_its_way(tmp_path):
    class Watched(Simulated):
        def move(self, angles, speed):
            way = self.arm.forward(np.linspace(self.stands, angles, 200))[:, :3, 3]
            assert (way >= box.low - 0.01).all() and (way <= box.high + 0.01).all()
            super().move(angles, speed)

    box = Box(np.array([0.5, -0.3, 0.1]), np.array([1.0, 0.5, 0.6]))
    station = Watched()
    run(station, tmp_path, most=12, box=box)
    assert station.calls.count("move") > 11, "none went by way of home"


def test_where_the_arm_was_left_outside_the_box_it_stays(tmp_path):
    run(Simulated(), tmp_path, most=10)
    station = Simulated()
    station.stands = station.stands + 1.2 * np.eye(6)[1]
    with pytest.raises(StationFailed, match="no straight path .* try: move it back by hand"):
        run(station, tmp_path, box=AROUND)
    assert "move" not in station.calls


def test_postures_are_within_the_limits_of_both():
    station = Simulated()
    home, limits = station.stands, (np.full(6, -2.5), np.full(6, 2.0))
    postures = AllowedPostures(station.arm, home, limits, 0.5, AROUND).joints
    assert (np.abs(postures - home) <= 0.5).all()
    assert (postures >= -2.5).all() and (postures <= 2.0).all()
    for changed, match in (
        ({"home": home + 0.2 * np.eye(6)[2]}, "first posture is 'elbow_joint at 2.1'"),
        ({"box": Box(np.zeros(3), np.full(3, 0.5))}, "without the tool, which is at"),
        ({"box": Box.read("77 cm to 78 cm, 16 cm to 17 cm, 23 cm to 25 cm")}, "left by all"),
    ):
        given = {"home": home, "limits": limits, "span": 0.5, "box": AROUND} | changed
        with pytest.raises(InvalidSetting, match=match):
            AllowedPostures(station.arm, **given)


@pytest.mark.parametrize("text", ["1 m to 2 m", "a, b, c", "1 m to 0 m, 0 m to 1 m, 0 m to 1 m"])
def test_a_box_is_three_ranges(text):
    with pytest.raises(InvalidSetting, match="--box"):
        Box.read(text)


@pytest.fixture
def ten_rows(tmp_path):
    """A table that was begun, and what is in it."""
    run(Simulated(), tmp_path, most=10)
    return tmp_path / "table.csv", (tmp_path / "table.csv").read_bytes()


def test_a_torn_row_is_dropped_and_nothing_else(ten_rows, tmp_path):
    (table, whole), told = ten_rows, []
    for cut in (len(whole) - 1, len(whole) // 2, whole.index(b"\n") + 5, 10):
        table.write_bytes(whole[:cut])
        run(Simulated(), tmp_path, most=10, on_progress=told.append)
        assert "a row without its end was dropped: " in "".join(told)
        assert table.read_bytes() == whole


@pytest.mark.parametrize("text", ["a note", "a note\n", "wrist_3_joint [rad],x [m]\n", "\n"])
def test_what_is_not_ours_is_left_as_it_is(text, tmp_path):
    (tmp_path / "table.csv").write_text(text)
    with pytest.raises(InvalidFile, match="it is no table that recalib live began"):
        run(Simulated(), tmp_path)
    assert (tmp_path / "table.csv").read_text() == text


def test_a_row_for_which_there_is_no_room_leaves_the_table(ten_rows, tmp_path, monkeypatch):
    (table, whole), write = ten_rows, os.write
    monkeypatch.setattr(os, "write", lambda file, row: write(file, row[: len(row) // 2]))
    with pytest.raises(InvalidFile, match="there is no room for a row"):
        run(Simulated(), tmp_path, most=11)
    assert table.read_bytes() == whole


def test_a_table_is_begun_by_us_and_written_by_one(tmp_path):
    station, table = Simulated(), tmp_path / "table.csv"

    def ask(posture):
        with pytest.raises(InvalidFile, match="another process writes it"):
            run(Simulated(), tmp_path)
        return False

    run(station, tmp_path, ask)
    table.write_text(table.read_text().replace("elbow_joint [rad]", "elbow_joint [deg]"))
    with pytest.raises(InvalidFile, match=r"no column 'elbow_joint \[rad\]'"):
        run(Simulated(), tmp_path)


@pytest.mark.parametrize("hangs", [False, True])
def test_it_is_closed_where_it_was_opened_unless_it_hangs_there(hangs, monkeypatch):
    """Graphics are bound to a thread."""
    monkeypatch.setattr("recalib.station.guarded.STOPPING", 5.0)

    class Bound(Simulated):
        closed, freed = None, threading.Event()

        def __init__(self):
            super().__init__()
            self.opened = threading.get_ident()

        def move(self, goal, speed):
            self.freed.wait()

        def close(self):
            self.closed = threading.get_ident()

    made = []
    guarded = Guarded(lambda: made.append(Bound()) or made[0], Simulated().joints, 0.2)
    (station,) = made
    if hangs:
        with pytest.raises(StationFailed, match="has not answered when asked to move"):
            guarded.move(station.angles(), 1.0)
    guarded.close()
    station.freed.set()
    assert station.closed is not None and (station.closed == station.opened) is not hangs


LINE = "live tests.station.simulated:{} ur10_robot.urdf --tool tool0 --most 14"


def test_it_can_be_watched(tmp_path):
    station, urdf, seen = Simulated(), find_urdf("ur10_robot.urdf"), []
    with rr.RecordingStream("live") as rec:
        rec.save(tmp_path / "live.rrd")
        view = LiveView(station.arm, urdf.read_bytes(), urdf, rec)

        def show(rows, running):
            seen[:] = [rows]
            view.show(rows, running)

        run(station, tmp_path, most=14, on_row=show)
    its = logged(tmp_path / "live.rrd")
    entities = {name.split()[0] for name in its}
    assert entities >= {"/line", "/measured", "/workspace", "/error/by_the_last_rows"}
    (errors,) = (its[name] for name in its if "/by_the_model Scalars" in name)
    assert len(np.concatenate(errors)) == 14 - 5
    assert np.all(np.concatenate(errors) < 100), "mm"
    # in the base, where the target is as far from the tool in all postures, but for what is off
    measured = np.concatenate(its["/measured Points3D:positions"]).reshape(-1, 3)[-14:]
    away = np.linalg.norm(measured - station.arm.forward(seen[0].joints)[:, :3, 3], axis=1)
    assert np.ptp(away) < 0.05


def test_without_a_display_nothing_moves(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "CI"):
        monkeypatch.delenv(name, raising=False)
    assert main([*LINE.format("Simulated").split(), "--yes", "--view"]) == REFUSED
    said = "recalib: --view is 'without a window'; expected: a display, for rerun\n"
    assert capfd.readouterr().err == said
    assert "CI" not in os.environ and not list(tmp_path.iterdir())


def test_the_command_asks(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.stdin.readline", iter(["\n", "no\n"]).__next__, raising=False)
    assert main(LINE.format("Simulated").split()) == REFUSED
    told = capsys.readouterr().err
    assert told.count("? Enter: yes; anything else: end") == 2
    assert "enough: you ended it" in told and "it has 2 rows; expected: at least 10" in told


def begun(folder, most=14):
    """`recalib live` in a folder, in a process of its own."""
    folder.mkdir(exist_ok=True)
    line = LINE.format("Lasting").replace("14", str(most))
    return subprocess.Popen(
        [sys.executable, "-m", "recalib", *line.split(), "--yes"],
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )


def rows(folder) -> list[str]:
    table = folder / "measurements.csv"
    return table.read_text().splitlines() if table.exists() else []


def unwritten(folder) -> int:
    """How many measurements are not in the table."""
    log = folder / "measured"
    taken = len(log.read_text().splitlines()) if log.exists() else 0
    return taken - len(rows(folder)[1:])


@pytest.mark.slow
def test_killed_at_any_moment_it_goes_on_as_if_it_had_not_been(tmp_path):
    once, killed, most = tmp_path / "once", tmp_path / "killed", 40  # it ends before that
    with begun(once, most) as process:
        process.communicate()
    moments, before, lost = random.Random(8), [], 0
    for _ in range(20):
        with begun(killed, most) as process:
            process.stderr.readline()  # it is about to make its first move
            time.sleep(moments.uniform(0, 0.3))
            process.kill()
            process.communicate()
        assert process.returncode == -signal.SIGKILL
        assert rows(killed)[: len(before)] == before
        before = rows(killed)
        # what was measured and not yet on the disk is lost with the process: one row, and no more
        assert unwritten(killed) - lost in (0, 1)
        lost = unwritten(killed)
    with begun(killed, most) as process:
        process.communicate()
    assert process.returncode == DONE
    assert rows(killed) == rows(once) and len({*rows(once)}) == len(rows(once))
    measured = (killed / "measured").read_text().splitlines()
    assert unwritten(killed) == lost and len({*measured}) == len(rows(once)) - 1


def test_one_that_is_terminated_stops_the_arm_first(tmp_path):
    with begun(tmp_path) as process:
        process.stderr.readline()
        process.terminate()
        told = process.communicate()[1]
    assert "recalib: interrupted; the station was told to stop" in told
    assert process.returncode == REFUSED


def test_a_command_takes_the_target_where_it_should_be(tmp_path):
    station = Simulated()
    run(station, tmp_path, most=20)
    with few_folds():
        correction = calibrate_arm(
            "ur10_robot.urdf", tmp_path / "table.csv", tool="tool0"
        ).correction
    corrector, near = Corrector(correction), station.stands
    goal = station.real.poses(near[None] + 0.05, noise=(0, 0))[0]
    command = corrector.command(goal, near, target="the target")
    there = station.real.poses(command[None], noise=(0, 0))[0]
    assert np.linalg.norm((there - goal)[:3, 3]) < 1e-3
    position = corrector.command(goal[:3, 3], near, target="the target")
    assert np.abs(position - near).max() < np.abs(command - near).max() + 0.05
    tool = correction.calibration.forward(near[None])[0]
    np.testing.assert_allclose(corrector.command(tool, near + 0.02), near, atol=1e-6)
    with pytest.raises(NotReached):
        corrector.command(np.array([9.0, 0, 0]), near)
    with pytest.raises(UnknownName, match="unknown target"):
        corrector.command(goal, near, target="the board")


def test_the_error_by_the_last_rows_is_the_mean_of_predictions_by_those_before(tmp_path):
    kept = []
    watch = lambda rows, running: kept.append((rows, running))  # noqa: E731
    run(Simulated(noise=(5e-5, np.radians(0.01))), tmp_path, most=20, on_row=watch)
    rows, running = kept[-1]
    off = []
    for row in range(len(rows) - 8, len(rows)):
        before = running.calibration(rows[:row])
        gap = before.predict(rows.joints[row : row + 1])[0] - rows.measured[row]
        off.append(np.linalg.norm(gap[:3, 3]))
    assert len(rows) == 20 and np.ptp(off) > 0
    assert running.error(rows).by_rows == pytest.approx(np.mean(off))
    for far, believed in ((0.045, True), (0.055, False)):  # m
        measured = rows.measured.copy()
        measured[-1, 2, 3] += far
        assert (running.check(replace(rows, measured=measured)) is None) == believed


def test_the_same_postures_are_drawn_tomorrow(data_regression):
    """A calibration that was killed goes on with them."""
    station = Simulated()
    postures = AllowedPostures(station.arm, station.stands, station.limits, 0.5, AROUND)
    data_regression.check(plain(postures.joints))
