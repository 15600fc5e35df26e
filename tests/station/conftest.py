"""A live calibration that several tests look at, and waits that are short."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
import rerun as rr
from watched import LiveView

from recalib import Answer, LiveSettings, Observations, calibrate_live, load_shapes
from recalib.laboratory.live.running import RunningCalibration
from recalib.laboratory.live.session import Ended, Move
from recalib.nominal import find_urdf
from tests.station.simulated import Simulated

WAITS = {"INTERVAL": 0.0002, "SETTLING": 0.02, "PATIENCE": 0.3}  # s
MOST = "recalib.laboratory.live.allowed.MOST"


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """A simulated arm stands at once, and proposals are among a few postures."""
    monkeypatch.setattr(MOST, 60)
    for name, seconds in WAITS.items():
        monkeypatch.setattr(f"recalib.station.guarded.{name}", seconds)


@pytest.fixture
def all_postures(quick, monkeypatch):
    """Proposals are among all postures."""
    monkeypatch.setattr(MOST, 400)


class LiveSession(NamedTuple):
    """What a live calibration of a UR5 asked, measured and wrote."""

    station: Simulated
    end: Ended
    lines: list[str]
    proposed: list[Move]
    rows: Observations
    running: RunningCalibration
    table: Path
    recording: Path


@pytest.fixture(scope="session")
def session(tmp_path_factory) -> LiveSession:
    """Until the predicted error is 0.3 mm, and a few rows more."""
    folder, station = tmp_path_factory.mktemp("session"), Simulated("UR5", 1, FINE)
    files = folder / "table.csv", folder / "live.rrd"
    urdf, lines, proposed, shown = find_urdf("ur5_robot.urdf"), [], [], []
    with pytest.MonkeyPatch.context() as patch, rr.RecordingStream("live") as rec:
        for name, seconds in WAITS.items():
            patch.setattr(f"recalib.station.guarded.{name}", seconds)
        rec.save(files[1])
        view = LiveView(station.arm, urdf, rec)

        def ask(move: Move) -> Answer:
            proposed.append(move)
            return Answer.MOVE

        def show(rows, running):
            shown[:] = rows, running
            view.show(rows, running)

        shapes, _ = load_shapes(station.arm, urdf)
        watch = {"on_progress": lines.append, "on_row": show, "shapes": shapes}
        settings = LiveSettings(3e-4, speed=0.37)
        end = calibrate_live(lambda: station, station.arm, files[0], settings, ask, **watch)
    return LiveSession(station, end, lines, proposed, *shown, *files)


FINE = 1e-4, np.radians(0.01)  # m, rad
