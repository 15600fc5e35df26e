"""Several plants side by side: solving all their commands in one call is faster than in several."""

from collections.abc import Sequence

import numpy as np

from recalib.damaged.plant import Plant
from recalib.loop.interfaces import Outcome
from recalib.nominal.controller import Controller, Targets
from recalib.nominal.poses import Workspace


class Fleet:
    """Plants behind one nominal controller that are one plant to a learner.

    Their runs follow one another: those of the first plant, then those of the second, and so on.

    Args:
        controller: of all the plants.
        plants: with the same number of runs each.
    """

    def __init__(self, controller: Controller, plants: Sequence[Plant]):
        self._controller, self._plants = controller, plants

    @property
    def workspace(self) -> Workspace:
        """The workspace in whose coordinates commands and achieved poses are given."""
        return self._controller.robot.workspace

    @property
    def moves(self) -> int:
        """How many moves were commanded in each run."""
        return self._plants[0].moves

    @property
    def refused(self) -> np.ndarray | int:
        """(run,) how many moves the controller refused; 0 before the first."""
        return np.concatenate([plant.refused for plant in self._plants]) if self.moves else 0

    def execute(self, commands: np.ndarray) -> Outcome:
        """As a plant's."""
        outcomes = [plant.execute_targets(targets) for plant, targets in self._shares(commands)]
        return Outcome(*map(np.concatenate, zip(*outcomes, strict=True)))

    def achieve(self, commands: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """As a plant's."""
        poses, executed = zip(
            *(plant.achieve_targets(targets) for plant, targets in self._shares(commands)),
            strict=True,
        )
        return np.concatenate(poses), np.concatenate(executed)

    def _shares(self, commands: np.ndarray) -> list[tuple[Plant, Targets]]:
        angles, executed = (
            np.split(part, len(self._plants)) for part in self._controller.targets(commands)
        )
        return list(zip(self._plants, map(Targets, angles, executed), strict=True))
