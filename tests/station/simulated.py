"""Stations that are simulated: an arm that is off, where its encoders do not say so."""

import os
import time
import zlib
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.nominal.arms import load_arm
from recalib.station.interface import StationFailed
from tests.identification.real import ARMS, NOISE, Real

HOMES = {"UR10": [0, -1.2, 1.9, -2.3, -1.6, 0], "Panda": [0, 0.2, 0, -2, 0, 2.2, 0.8]}  # rad


class Simulated:
    """An arm, and an instrument that sees its target in all postures.

    What is measured in a posture is the same each time. All calls are noted.
    """

    def __init__(self, name: str = "UR10", seed: int = 1, noise=NOISE):
        self.arm = load_arm(*ARMS[name])
        self.real, self.noise = Real(self.arm, seed), noise
        self.joints = self.arm.joints
        model = self.arm.model
        self.limits = model.lowerPositionLimit, model.upperPositionLimit
        self.stands, self.calls = np.array(HOMES[name], dtype=float), []

    def move(self, angles, speed):
        self.calls.append("move")
        self.stands = angles

    def angles(self):
        return self.stands

    def pose(self):
        self.real.random = np.random.default_rng(zlib.crc32(np.round(self.stands, 6).tobytes()))
        return self.real.poses(self.stands[None], noise=self.noise)[0]

    def measure(self):
        self.calls.append("measure")
        pose = self.pose()
        turn = Rotation.from_matrix(pose[:3, :3]).as_quat()
        names = "x [m]", "y [m]", "z [m]", "qx", "qy", "qz", "qw"
        return dict(zip(names, [*pose[:3, 3], *turn], strict=True))

    def stop(self):
        self.calls.append("stop")


class Lasting(Simulated):
    """One whose arm stays where it was when the process that moved it was killed.

    It moves in steps; the posture is in the file `stands`. What is measured goes to `measured`.
    """

    def __init__(self):
        super().__init__()
        if Path("stands").exists():
            self.stands = np.array([float(number) for number in Path("stands").read_text().split()])

    def move(self, angles, speed):
        for posture in np.linspace(self.stands, angles, 5):
            self.stands = posture
            Path("stands.part").write_text(" ".join(map(repr, posture.tolist())))
            os.replace("stands.part", "stands")
            time.sleep(0.01)

    def measure(self):
        with open("measured", "a") as log:
            log.write(f"{self.stands.round(6).tolist()}\n")
        return super().measure()


class Collides(Simulated):
    def move(self, angles, speed):
        super().move(angles, speed)
        if self.calls.count("move") == 3:
            raise StationFailed("the protective stop of the arm is on")


class Stalls(Simulated):
    def move(self, angles, speed):
        super().move(angles, speed)
        if self.calls.count("move") == 3:
            time.sleep(3)


class GetsLost(Simulated):
    def move(self, angles, speed):
        super().move(angles, speed)
        if self.calls.count("move") == 3:
            self.stands = angles + 0.05 * np.eye(6)[2]


class KeepsMoving(Simulated):
    def angles(self):
        if self.calls.count("move") == 3:
            self.stands = self.stands + 0.002
        return self.stands


class MovesWhileItMeasures(Simulated):
    def measure(self):
        cells = super().measure()
        self.stands = self.stands + 0.01
        return cells


class HasAnError(Simulated):
    def measure(self):
        return super().measure()["temperature"]


class MeasuresForever(Simulated):
    def measure(self):
        super().measure()
        time.sleep(3)


class MeasuresNoNumber(Simulated):
    def measure(self):
        cells = super().measure()
        return cells | {"y [m]": np.nan} if self.calls.count("measure") == 4 else cells


class MeasuresOtherThings(Simulated):
    def measure(self):
        cells = super().measure()
        return cells if self.calls.count("measure") < 4 else cells | {"temperature": 20.0}


class MeasuresNothing(Simulated):
    def measure(self):
        super().measure()
        return {"picture": "000.png"}


class Lies(Simulated):
    """It says that it is where it was sent, but it moves no more."""

    def move(self, angles, speed):
        super().move(angles, speed)
        self.stuck = self.stuck if self.calls.count("move") > 9 else angles

    def pose(self):
        told = self.stands
        self.stands = getattr(self, "stuck", told)
        pose, self.stands = super().pose(), told
        return pose


class IsBlind(Simulated):
    def measure(self):
        return super().measure() if self.calls.count("measure") < 2 else None


class SeesNothing(Simulated):
    def measure(self):
        return None


class ForgetsAJoint(Simulated):
    def angles(self):
        return self.stands[:5]


class HasOtherJoints(Simulated):
    def __init__(self):
        super().__init__()
        self.joints = [f"joint_{number}" for number in range(6)]


class HasNoLimits(Simulated):
    def __init__(self):
        super().__init__()
        self.limits = self.limits[::-1]


class Disappears(Simulated):
    def angles(self):
        if self.calls.count("move") == 3:
            raise ConnectionResetError("connection reset by peer")
        return self.stands
