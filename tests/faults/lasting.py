"""A simulated arm that outlives the process that moves it."""

import os
import time
from pathlib import Path

import numpy as np

from tests.station.simulated import Simulated


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
