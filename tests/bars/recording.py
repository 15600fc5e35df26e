"""The paper, live, in the viewer: what the study records, of the arm in MuJoCo that droops.

It writes results/live_paper/live_paper.rrd (5 minutes). The links are drawn where kinematics has
them; where the tool lands is where the physics takes it.

    python -m tests.bars.recording
"""

from collections.abc import Sequence

from simulated_arm import PhysicsStation

from recalib import Controller, Plant
from recalib.numerics.randomness import generator
from replication.recording.recorded import published_errors
from replication.recording.writing import watch_all, write_recording
from replication.scenarios.plants import Resolved
from replication.scenarios.resolving import resolve
from tests.bars.paper_live import CONDITIONS, KEPT, study, tuned

SEED = 0


class InPhysics(Resolved):
    """A scenario whose robot moves as its dynamics let it."""

    def plant(self, controller: Controller, seed: int, runs: Sequence[int]) -> Plant:
        condition = CONDITIONS["physics"]
        rngs = [generator(seed, self.scenario, run, "disturbances") for run in runs]
        moving = PhysicsStation(self.arm(controller.robot), condition.gears)
        return Plant(controller, moving, condition.noise, rngs)


def arm() -> InPhysics:
    """The study's own scenario."""
    (resolved,), _ = resolve(study(), study().robot, [study().scenario])
    return InPhysics(**dict(resolved))


def main() -> None:
    """Train the study's recorded learners on it, and write the recording."""
    KEPT.mkdir(parents=True, exist_ok=True)
    watched = watch_all(study(), arm(), tuned(), SEED)
    published = published_errors(study(), study().scenario)
    write_recording(KEPT / "live_paper.rrd", arm(), watched, published)


if __name__ == "__main__":
    main()
