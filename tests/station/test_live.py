"""A calibration that moves the arm itself: when it ends, what it asks, and what stops it."""

import os
import re
import signal
import threading
import time
from contextlib import suppress
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from recalib import (
    Answer,
    Description,
    InvalidFile,
    InvalidSetting,
    LiveSettings,
    NotReached,
    Observations,
    StationFailed,
    UnknownName,
    calibrate_arm,
    calibrate_live,
)
from recalib.laboratory.command_line import DONE, REFUSED, main
from recalib.laboratory.live.allowed import AllowedPostures, Box
from recalib.laboratory.live.running import RunningCalibration
from recalib.laboratory.live.session import Interrupted
from recalib.station import Guarded
from tests.conftest import few_folds
from tests.identification.real import anywhere
from tests.logged import logged
from tests.station.conftest import FINE
from tests.station.simulated import HOMES, Ordered, Simulated, Spoilt

SPAN = np.radians(45)


def run(station, folder, ask=lambda move: Answer.MOVE, on_progress=lambda line: None, **settings):
    table, settings = folder / "table.csv", LiveSettings(**{"floor": None} | settings)
    return calibrate_live(lambda: station, station.arm, table, settings, ask, None, on_progress)


def few(count: int):
    """Answers for a few moves and an end: no calibration, which takes long, is needed."""
    answers = iter([Answer.MOVE] * count)
    return lambda move: next(answers, Answer.END)


def test_it_says_where_the_tool_will_be_and_ends_as_soon_as_the_arm_is_right(session):
    assert session.end.reason.endswith("; 0.3 mm was requested")
    assert session.end.rows == len(session.rows) <= 14 and "stop" not in session.station.calls
    station, home = session.station, session.rows.joints[0]
    low, high = np.maximum(station.limits[0], home - SPAN), home + SPAN
    fresh = np.random.default_rng(0).uniform(low, high, (200, len(low)))
    predicted = session.running.calibration(session.rows).predict(fresh)
    gaps = (predicted - station.real.poses(fresh, noise=(0, 0)))[:, :3, 3]
    assert np.linalg.norm(gaps, axis=1).mean() < 3e-4
    predicted = session.running.error(session.rows)
    last = f"row {len(session.rows)}: the predicted error is {1e3 * predicted:.3g} mm"
    assert session.lines[-1] == last
    ranges = re.findall(r"([xyz]) from (-?\d+) to (-?\d+) mm", session.lines[0])
    low, high = np.array([(float(a), float(b)) for _, a, b in ranges]).T
    places = 1e3 * np.array([move.tool_after for move in session.proposed])
    assert [axis for axis, *_ in ranges] == [*"xyz"]
    assert (places >= low - 1).all() and (places <= high + 1).all() and low[2] > 0


def test_each_move_is_asked_for_and_made_at_the_speed_that_was_set(session):
    assert len(session.proposed) == len(session.station.moves) == len(session.rows) - 1
    for move, (angles, speed) in zip(session.proposed, session.station.moves, strict=True):
        assert np.array_equal(move.goal, angles) and speed == 0.37
        ends = session.station.arm.forward(np.array([move.start, move.goal]))[:, :3, 3]
        assert np.allclose(ends, [move.tool_before, move.tool_after])
    starts = np.array([move.start for move in session.proposed])
    assert np.array_equal(starts, session.rows.joints[:-1])


def test_it_can_be_watched(session):
    shown = logged(session.recording)
    assert {name.split()[0] for name in shown} >= {"/line", "/measured", "/workspace"}
    (errors,) = (shown[name] for name in shown if "/predicted Scalars" in name)
    assert len(np.concatenate(errors)) == len(session.rows) - 9
    assert np.concatenate(errors)[-1] == pytest.approx(1e3 * session.running.error(session.rows))
    # in the base, where the target is as far from the tool in all postures, but for its errors
    measured = np.concatenate(shown["/measured Points3D:positions"])
    measured = measured.reshape(-1, 3)[-len(session.rows) :]
    tool = session.station.arm.forward(session.rows.joints)[:, :3, 3]
    assert np.ptp(np.linalg.norm(measured - tool, axis=1)) < 0.05


def test_a_command_takes_the_target_where_it_should_be(session):
    station = session.station
    with few_folds():
        correction = calibrate_arm("ur5_robot.urdf", session.table, tool="tool0").correction
    posture = station.stands
    goal = station.real.poses(posture[None] + 0.05, noise=(0, 0))[0]
    command = correction.command(goal, posture, target="the target")
    reached = station.real.poses(command[None], noise=(0, 0))[0]
    assert np.linalg.norm((reached - goal)[:3, 3]) < 1e-3
    position = correction.command(goal[:3, 3], posture, target="the target")
    assert np.abs(position - posture).max() < np.abs(command - posture).max() + 0.05
    pose = correction.calibration.predict(posture[None])[0]
    np.testing.assert_allclose(correction.command(pose, posture + 0.02), posture, atol=1e-6)
    for turn in (-1.7, 1.7):  # rad
        with pytest.raises(NotReached, match="only with wrist_3_joint more than 90 deg"):
            correction.command(pose, [posture + turn * np.eye(6)[5]])
    with pytest.raises(NotReached):
        correction.command(np.array([9.0, 0, 0]), posture)
    with pytest.raises(UnknownName, match="unknown target"):
        correction.command(goal, posture, target="the board")
    singular, refused = posture * [1, 1, 1, 1, 0, 1], []  # joints 4 and 6 are in line
    for turn in 0.05 * np.random.default_rng(0).normal(size=(20, 3)):
        goal = correction.calibration.predict(singular[None])[0]
        goal[:3, :3] = Rotation.from_rotvec(turn).as_matrix() @ goal[:3, :3]
        try:
            assert np.abs(correction.command(goal, singular) - singular).max() <= np.pi / 2
        except NotReached as error:
            refused.append(str(error))
    assert any("more than 90 deg" in text for text in refused)


def test_three_rows_in_a_row_that_do_not_fit_are_no_outliers(session):
    """A tripod was bumped; one or two may be outliers."""
    rows, station, bump = session.rows, session.station, anywhere(np.random.default_rng(0), 0)
    bump[:3, :3], bump[:3, 3] = np.eye(3), [6e-3, -6e-3, 5e-3]  # m
    more = AllowedPostures(station.arm, rows.joints[0], station.limits, SPAN).joints[:5]
    joints = np.concatenate([rows.joints, more])
    measured = np.concatenate([rows.measured, station.real.poses(more, noise=FINE)])

    def checked(count, *moved, part=1.0):
        poses = measured.copy()
        poses[[*moved]] = (part * bump + (1 - part) * np.eye(4)) @ poses[[*moved]]
        return session.running.check(Observations(joints, poses)[:count])

    count = len(rows)
    assert checked(count + 5) is None and checked(count + 2, count, count + 1) is None
    assert checked(count + 4, count, count + 2, count + 3) is None
    assert checked(count + 3, count, count + 1, count + 2, part=0.1) is None  # 1 mm
    wrong = checked(count + 3, count, count + 1, count + 2)
    bump[:3, 3] = 8 * FINE[0]  # some four deviations of a prediction
    assert checked(count + 3, count, count + 1, count + 2) is None
    rows = f"in rows {count + 1} to {count + 3}"
    assert re.match(f"{rows} the target was measured (9|10).* mm from", wrong)
    assert "The instrument or the target may have moved" in wrong
    far = measured[: count + 1].copy()
    for away, plausible in ((0.045, True), (0.055, False)):  # m
        far[-1, 2, 3] = measured[count, 2, 3] + away
        observations = Observations(joints[: count + 1], far)
        assert (session.running.check(observations) is None) == plausible


def test_more_counts_as_less_sure_where_the_last_rows_were_a_surprise(session):
    """Not where one was, or none; and the noise of what is measured is part of the error."""
    rows, error, surprised = session.rows, session.running.error(session.rows), []
    assert session.running.workspace(rows)[1].min() > np.sqrt(3) * FINE[0]
    for last in (0, 1, 4):
        spoilt = rows.measured.copy()
        spoilt[len(rows) - last :, :3, 3] += 2e-3 * np.random.default_rng(0).normal(size=(last, 3))
        fresh = RunningCalibration(session.station.arm, Description(), session.running._postures)
        seen = replace(rows, measured=spoilt)
        surprised.append(fresh.error(seen) / fresh.workspace(seen)[1].mean())
    assert surprised[:2] == pytest.approx([1, 1], abs=0.08) and fresh.error(seen) > 2 * error
    assert surprised[2] > 1.2, surprised
    assert session.running.error(rows[:9]) == np.inf


def test_it_ends_if_more_is_of_no_use_or_if_it_is_as_long_as_allowed(session, tmp_path):
    table = tmp_path / "table.csv"
    table.write_bytes(session.table.read_bytes())
    again = partial(run, Simulated("UR5", 1, FINE), tmp_path)
    assert again(most=10).reason.endswith("; the limit of 10 rows is reached")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("recalib.laboratory.live.session.SOON", len(session.rows))
        patch.setattr("recalib.laboratory.live.session.USELESS", 0.5)
        assert again(error=1e-6).reason.endswith("10 more rows would reduce it by less than 50 %")


@pytest.mark.usefixtures("all_postures")
def test_postures_are_proposed_on_the_side_where_the_target_was_seen():
    station = Simulated()
    home = station.stands
    postures = AllowedPostures(station.arm, home, station.limits, SPAN)
    proposing = RunningCalibration(station.arm, Description(), postures)
    for count in (4, 25):  # without, and with a calibration
        visible = postures.joints[postures.joints[:, 0] < home[0]][:count]
        mirrored = [posture + 2 * (home[0] - posture[0]) * np.eye(6)[0] for posture in visible]
        rows = Observations(visible, station.real.poses(visible, noise=station.noise))
        assert proposing.next_posture(rows, [])[0] > home[0]
        assert proposing.next_posture(rows, mirrored)[0] <= home[0]
        to_seen, to_unseen = (
            np.linalg.norm(postures.joints[:, None] - known, axis=2).min(axis=1)
            for known in (visible, mirrored)
        )
        farthest = np.where(to_seen <= to_unseen, np.minimum(to_seen, to_unseen), 0).argmax()
        if count == 4:
            expected = postures.joints[farthest]
            assert np.array_equal(proposing.next_posture(rows, mirrored), expected)
        everywhere = [posture + 0.05 for posture in postures.joints]
        assert proposing.next_posture(rows, everywhere) is not None
    rows, gaps, avoided = Observations(home[None], station.real.poses(home[None])), [], []
    for _ in range(9):  # the more there are without a sight, the nearer is the next
        avoided.append(proposing.next_posture(rows, avoided))
        gaps.append(np.linalg.norm(avoided[-1] - home))
    assert max(gaps[4:]) < 0.7 * gaps[0]


def raising(error):
    raise error


def moved(station) -> int:
    return station.calls.count("move")


def measured(station) -> int:
    return station.calls.count("measure")


def stuck(station, cells):
    """It says that it is where it was sent, but after nine moves it moves no more."""
    station.last = cells if moved(station) <= 9 else station.last
    return station.last


PROTECTIVE = "the protective stop of the arm is on"
MEASURED = {  # by the message, what it says that it measures
    r"during a measurement, the tool moved by 0\.[1-9]\d* mm; expected: at most 0.1 mm": (
        lambda station, cells: cells if station.shift(3e-4).any() else None
    ),
    "asked to measure, the station raised KeyError: 'heat'": lambda _, cells: cells["heat"],
    "the station has not answered for 0.3 s when asked to measure": lambda *_: time.sleep(1),
    "is invalid: row 4 of column 'y' is 'nan'; expected: a number": lambda station, cells: (
        cells | {"y [m]": np.nan} if measured(station) == 4 else cells
    ),
    "is invalid: its columns are .*, qw; the station gives .*, heat": lambda station, cells: (
        cells if measured(station) < 4 else cells | {"heat": 20.0}
    ),
    "is invalid: it has no measured positions; expected: x, y": lambda *_: {"picture": "0.png"},
    "in row 1. the target was measured .* mm from its prediction by the .* rows before": stuck,
    "out of sight in 10 postures in a row.* try: a smaller --span": lambda station, cells: (
        cells if measured(station) < 2 else None
    ),
    "the target is out of sight in the first posture; try: start": lambda *_: None,
    "is invalid: 000.png is in an earlier row; expected: a new file for each picture": (
        lambda _, cells: cells | {"picture": "000.png"}
    ),
    "is invalid: it is not CSV in UTF-8": lambda _, cells: cells | {"target": "\ud800"},
    "is invalid: it has the targets 1, 2; expected: a single one": lambda station, cells: (
        cells | {"target": str(measured(station))}
    ),
    "is invalid: it has more than one column 'elbow_joint'": lambda _, cells: (
        cells | {"elbow_joint [rad]": 0.1}
    ),
}
ANGLES = {  # by the message, where it says that it stands
    "0.02 s after the arm should have stopped, the tool still moves by .* mm; expected: at most": (
        lambda station, angles: station.shift(1e-3) if moved(station) == 3 else angles
    ),
    r"angles are \[0.0, .*, nan\]; expected: 6 finite numbers": lambda *_: [0.0] * 5 + [np.nan],
    "the station's angles are 'none'; expected: numbers": lambda *_: "none",
    r"the station's angles are \[True, .*; expected: numbers": lambda *_: [True] * 6,
    r"the station's angles are \[10000.*; expected: numbers": lambda *_: [10**400] * 6,
    r"angles are up to 132 rad; expected: up to 720 deg. Are they in rad\?": (
        lambda station, angles: np.degrees(angles)
    ),
    "asked to report its angles, the station raised OSError: no route": lambda station, angles: (
        raising(OSError("no route")) if moved(station) == 3 else angles
    ),
}
STOPPED = {  # by the message, what a station does
    PROTECTIVE: {"moved": lambda station: raising(StationFailed(PROTECTIVE))},
    "the station has not answered for 0.3 s when asked to move": {"moved": lambda _: time.sleep(1)},
    **{
        f"after a move, {joint}_joint is 0.05 rad or m from its command": {
            "moved": lambda station, by=by: station.shift(*by)
        }
        for joint, by in (("elbow", [0, 0, 0.05, 0, 0, 0]), ("wrist_1", [0, 0, 0, -0.05, 0, 0]))
    },
    "the station's joints are joint_0, .*; expected: those of the arm": {
        "joints": [f"joint_{number}" for number in range(6)]
    },
    **{
        f"limits of shoulder_pan_joint are {ends}; expected: the lower one first": {
            "limits": np.outer(limits, np.ones(6))
        }
        for ends, limits in {"2 to -2": [2, -2], "1 to 1": [1, 1]}.items()
    },
    **{message: {"measured": own} for message, own in MEASURED.items()},
    **{message: {"angles": own} for message, own in ANGLES.items()},
}


@pytest.mark.parametrize(("message", "changes"), STOPPED.items(), ids=STOPPED)
def test_whatever_goes_wrong_it_stops_with_a_sentence_and_moves_no_more(message, changes, tmp_path):
    station, lines = Spoilt(**changes), []
    with pytest.raises(StationFailed, match=message) as raised:
        run(station, tmp_path, on_progress=lines.append)
    if wrong := re.match(r"in row (\d+) the target", str(raised.value)):  # which is not written
        assert len((tmp_path / "table.csv").read_text().splitlines()) == int(wrong[1])
    assert {*station.calls[station.calls.index("stop") :]} == {"stop"}
    assert "10 postures" not in message or moved(station) == 10
    rows = (tmp_path / "table.csv").exists()
    assert bool(re.match(r"stopped; \d+ rows are in ", (lines or [""])[-1])) == rows


@pytest.mark.parametrize("joint", range(6))
def test_one_joint_that_creeps_is_enough_not_to_stand(joint, tmp_path):
    creep = 1e-3 * np.eye(6)[joint]  # rad from a reading to the next
    station = Spoilt(angles=lambda station, angles: station.shift(*creep))
    with pytest.raises(StationFailed, match="the tool still moves by"):
        run(station, tmp_path)
    assert measured(station) == 0


@pytest.mark.parametrize("fails", [lambda: None, lambda: raising(OSError("no picture"))])
def test_a_measurement_that_fails_is_repeated(fails, tmp_path):
    """Twice, before the posture is given up."""
    seen = lambda station, cells: cells if measured(station) % 3 == 0 else fails()  # noqa: E731
    station, lines = Spoilt(measured=seen), []
    assert run(station, tmp_path, few(2), lines.append).rows == 3
    assert measured(station) == 3 * 3 and "out of sight" not in " ".join(lines)


def test_joints_in_another_order_are_the_same_joints(tmp_path):
    widths = np.linspace(0.1, 0.6, 6)  # rad: each joint has limits of its own
    for folder, station in (("other", Ordered()), ("own", Simulated())):
        (tmp_path / folder).mkdir()
        order = getattr(station, "ORDER", slice(6))
        station.limits = [(station.stands + sign * widths)[order] for sign in (-1, 1)]
        assert run(station, tmp_path / folder, few(3)).rows == 4
    tables = [tmp_path / folder / "table.csv" for folder in ("other", "own")]
    assert tables[0].read_bytes() == tables[1].read_bytes()


@pytest.mark.usefixtures("all_postures")
@pytest.mark.parametrize("answer", [True, None, "move"])
def test_an_answer_of_another_kind_is_no_end(answer, tmp_path):
    station = Simulated()
    with pytest.raises(InvalidSetting, match="the answer to a move is .* an instance of Answer"):
        run(station, tmp_path, lambda move: answer)
    assert not moved(station) and station.calls.count("stop") == 1


@pytest.mark.parametrize("made", [0, 1])  # moves of the way by home
def test_the_way_home_is_asked_for_and_may_be_refused(made, tmp_path):
    box = Box(np.array([0.5, -0.7, 0.2]), np.array([1.0, 0.8, 0.4]))
    station, home, goals = Simulated(), Simulated().stands.tolist(), []

    def ask(move):
        goals.append(move.goal.tolist())
        return Answer.END if home in goals[: len(goals) - made] else Answer.MOVE

    end = run(station, tmp_path, ask, error=1e-9, most=60, box=box)
    assert end.reason == "you ended it" and goals[-1 - made] == home
    assert [move.tolist() for move, _ in station.moves] == goals[:-1]


def test_an_arm_that_is_moved_by_hand_while_it_asks_is_not_sent(tmp_path):
    station = Simulated()

    def ask(move):
        station.stands = station.stands + 1.2 * np.eye(6)[0]
        return Answer.MOVE

    with pytest.raises(StationFailed, match="shoulder_pan_joint at .* try: move it by hand"):
        run(station, tmp_path, ask)
    assert "move" not in station.calls


def test_where_the_arm_was_parked_elsewhere_the_same_call_moves_nothing(tmp_path):
    run(Simulated(), tmp_path, few(1))
    station = Simulated()
    station.stands = station.stands + np.array([2.5, 1, -1.2, 0.5, 2, 1.5])
    with pytest.raises(StationFailed, match="stands with its tool at .* within --span"):
        run(station, tmp_path)
    assert "move" not in station.calls


def test_an_interrupt_stops_the_arm_also_while_it_is_about_to_stop(tmp_path, monkeypatch):
    """A terminal that is closed fails to be read, and interrupts a moment later."""
    station, stop = Simulated(), Guarded.stop
    ask = lambda move: raising(KeyboardInterrupt) if moved(station) else Answer.MOVE  # noqa: E731
    with pytest.raises(Interrupted, match="the station was told to stop"):
        run(station, tmp_path, ask)
    assert station.calls[-1] == "stop"
    station = Simulated()
    interrupts = iter([lambda: raising(KeyboardInterrupt)])
    monkeypatch.setattr(Guarded, "stop", lambda self: next(interrupts, lambda: stop(self))())
    with pytest.raises(OSError, match="hung up"):
        run(station, tmp_path, lambda move: raising(OSError("hung up")))
    assert station.calls[-1] == "stop"


def test_a_move_that_waited_for_its_turn_is_not_made_after_a_stop():
    station, free, busy = Simulated(), threading.Event(), threading.Event()
    guarded = Guarded(lambda: station, station.arm)
    station.angles = lambda: busy.set() or (free.wait() and station.stands)

    def ask(call):
        with suppress(StationFailed):
            call()

    calls = guarded.angles, partial(guarded.move, station.stands, 1.0)
    threads = [threading.Thread(target=ask, args=(call,)) for call in calls]
    for thread in threads:
        thread.start()
        busy.wait()
    time.sleep(0.05)
    guarded.stop()
    free.set()
    for thread in threads:
        thread.join()
    guarded.close()
    assert not station.moves


def test_a_move_that_begins_just_after_a_stop_is_stopped(monkeypatch):
    monkeypatch.setattr("recalib.station.guarded.PATIENCE", 60)  # s
    station, halted = Simulated(), threading.Event()
    guarded = Guarded(lambda: station, station.arm)

    def move(angles, speed):
        threading.Thread(target=guarded.stop).start()
        halted.wait()  # the first stop comes while the arm is still at rest
        halted.clear()
        assert halted.wait(5), "the arm moves after a stop"
        raise StationFailed("halted")

    station.move, station.stop = move, halted.set
    with pytest.raises(StationFailed, match="halted"):
        guarded.move(station.stands, 1.0)
    guarded.close()


def test_a_torn_row_is_dropped_and_nothing_else(tmp_path, monkeypatch):
    table, station, lines = tmp_path / "table.csv", Simulated(), []
    run(station, tmp_path, few(2))
    whole = table.read_bytes()
    *_, last = whole.splitlines(keepends=True)
    for cut in (len(whole) - 1, len(whole) - len(last) // 2, whole.index(b"\n") + 5, 10):
        table.write_bytes(whole[:cut])
        end = run(Simulated(), tmp_path, few(2 - max(0, whole[:cut].count(b"\n") - 1)),
                    lines.append)  # fmt: skip
        assert "an incomplete row was dropped: " in "".join(lines) and end.rows in (2, 3)
        assert whole.startswith(table.read_bytes())
        table.write_bytes(whole)
    write = os.write
    monkeypatch.setattr(os, "write", lambda file, row: write(file, row[: len(row) // 2]))
    with pytest.raises(InvalidFile, match="there is not enough space for a row"):
        run(Simulated(), tmp_path, few(1))
    assert table.read_bytes() == whole


@pytest.mark.parametrize("text", ["a note", "a note\n", "wrist_3_joint [rad],x [m]\n", "\n"])
def test_what_is_not_ours_is_left_as_it_is(text, tmp_path):
    (tmp_path / "table.csv").write_text(text)
    with pytest.raises(InvalidFile, match="it was not started by recalib live"):
        run(Simulated(), tmp_path)
    assert (tmp_path / "table.csv").read_text() == text


def test_a_table_is_begun_by_us_and_written_by_one(tmp_path):
    station, table = Simulated(), tmp_path / "table.csv"

    def ask(move):
        with pytest.raises(InvalidFile, match="another process writes it"):
            run(Simulated(), tmp_path)
        return Answer.END

    run(station, tmp_path, ask)
    table.write_text(table.read_text().replace("elbow_joint [rad]", "elbow_joint [deg]"))
    with pytest.raises(InvalidFile, match=r"column 'elbow_joint \[rad\]'"):
        run(Simulated(), tmp_path)


@pytest.mark.parametrize("hangs", [False, True])
def test_it_is_closed_where_it_was_opened_unless_it_hangs_there(hangs):
    """Graphics are bound to a thread."""

    class Bound(Simulated):
        closed, freed = None, threading.Event()

        def __init__(self):
            super().__init__()
            self.opened = threading.get_ident()

        def move(self, goal, speed):
            self.freed.wait()

        def close(self):
            self.closed = threading.get_ident()

    stations = []
    guarded = Guarded(lambda: stations.append(Bound()) or stations[0], Simulated().arm)
    (station,) = stations
    if hangs:
        with pytest.raises(StationFailed, match="has not answered for .* s when asked to move"):
            guarded.move(station.angles(), 1.0)
    guarded.close()
    station.freed.set()
    assert station.closed is not None and (station.closed == station.opened) is not hangs


LINE = "live {} ur10_robot.urdf --tool tool0 --most 14"
LINE += " --floor none --no-self-collision"  # which is tested where it is

SIMULATED = "tests.station.simulated:Simulated"


def type_lines(monkeypatch, *lines):
    answers = iter([f"{line}\n" for line in lines])
    monkeypatch.setattr("sys.stdin.readline", lambda: next(answers), raising=False)


def test_the_options_bound_each_move(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    moves, (station, home) = [], (Simulated(), Simulated().stands)

    def move(station, angles, speed):
        moves.append((angles, speed))
        station.stands = angles

    monkeypatch.setattr(Simulated, "move", move)
    type_lines(monkeypatch, *[""] * 8, "q")
    options = ["--span=20 deg", "--speed=0.03", "--floor=5 cm", "--no-self-collision"]
    box = ["--box", "60 cm to 90 cm", "-1 m to 1 m", "0 m to 30 cm"]
    assert main(["live", SIMULATED, "ur10_robot.urdf", "--tool=tool0", *options, *box]) == DONE
    goals = np.array([angles for angles, _ in moves])
    x, _, z = station.arm.forward(goals)[:, :3, 3].T
    assert np.radians(15) < np.abs(goals - home).max() <= np.radians(20)
    assert (x > 0.6).all() and (x < 0.9).all() and (z > 0.07).all() and (z < 0.3).all()
    assert [speed for _, speed in moves] == [0.03] * 8


@pytest.mark.parametrize("apart", [True, False])
def test_links_keep_apart_unless_told_otherwise(apart, tmp_path, monkeypatch, capsys):
    """The first session left the arm with a wrist on its upper arm."""
    monkeypatch.chdir(tmp_path)
    type_lines(monkeypatch, "q", "q")
    words = ["live", SIMULATED, "ur10_robot.urdf", "--tool=tool0", "--floor=none"]
    words += ["--span=140 deg", *["--no-self-collision"] * (not apart)]
    assert main(words) == DONE
    monkeypatch.setitem(HOMES, "UR10", [0, -1.2, 2.7, 0, -1.6, 0])
    assert main(words) == (REFUSED if apart else DONE)
    assert ("upper_arm_link nearer than 20 mm to wrist_2_link" in capsys.readouterr().err) == apart


def test_a_skipped_posture_is_not_proposed_again_and_an_end_is_no_error(
    tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    proposed = []
    for lines in (("", "s", "q"), ("s", "q"), ("q",)):
        type_lines(monkeypatch, *lines)
        assert main(LINE.format(SIMULATED).split()) == DONE
        printed = capsys.readouterr()
        proposed.append(re.findall(r"^tool from .* to (\(.*\)) mm", printed.err, re.MULTILINE))
        assert len(proposed[-1]) == len(lines) and "ended: you ended it" in printed.err
        assert printed.out == (
            "2 rows in measurements.csv; a calibration needs 10; to continue, repeat the command\n"
        )
    (_, skipped, second), (third, fourth), (fifth,) = proposed
    assert second == third and fourth == fifth and len({skipped, second, fourth}) == 3
    (tmp_path / "measurements.csv").unlink()
    assert main(LINE.format(SIMULATED).split()) == REFUSED
    assert "measurements_skipped.csv: it has postures that were" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["INT", "TERM", "HUP", "QUIT", "TSTP"])
def test_who_ends_or_suspends_it_stops_the_arm_first(name, tmp_path, monkeypatch, capsys):
    """Also who closes the terminal, or presses Ctrl-\\ or Ctrl-Z."""
    monkeypatch.chdir(tmp_path)
    signum = getattr(signal, f"SIG{name}")
    before = signal.getsignal(signum)
    monkeypatch.setattr("sys.stdin.readline", lambda: os.kill(os.getpid(), signum), raising=False)
    stopped = []

    def stop(station):  # who is in a hurry does it again
        os.kill(os.getpid(), signum)
        time.sleep(0.05)
        stopped.append(station)

    monkeypatch.setattr(Simulated, "stop", stop)
    assert main(LINE.format(SIMULATED).split()) == REFUSED
    assert "recalib: interrupted; the station was told to stop" in capsys.readouterr().err
    assert len(stopped) == 1 and signal.getsignal(signum) == before


def test_without_a_station_nothing_is_written(tmp_path, monkeypatch, capsys):
    with pytest.raises(StationFailed, match="returned None; expected: a station"):
        calibrate_live(lambda: None, Simulated().arm, tmp_path / "table.csv", LiveSettings())
    monkeypatch.chdir(tmp_path)
    assert main(LINE.format("tests.station.simulated:Unheard").split()) == REFUSED
    assert "rows are in" not in capsys.readouterr().err and not list(tmp_path.iterdir())
