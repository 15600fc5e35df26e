"""The paper, live, in the viewer: what the study records, of the arm in MuJoCo that droops.

It writes results/live_paper/live_paper.rrd (5 minutes). The links are drawn where kinematics has
them; where the tool lands is where the physics takes it.

    python -m tests.station.recording
"""

import os
from collections.abc import Sequence

from simulated_arm import PhysicsStation

from recalib.damaged.plant import Plant
from recalib.loop.interfaces import Learner
from recalib.nominal.controller import Controller
from recalib.numerics.randomness import generator
from recalib.study.experiments.settings import build_tuned
from recalib.study.plan.competitors import make_peer
from recalib.study.plan.recordings import Recording, recording
from recalib.study.recording.writing import write_recording
from recalib.study.scenarios.assignments import assign
from recalib.study.scenarios.nominal import nominal
from recalib.study.scenarios.plants import Resolved, resolve
from tests.station.paper_live import CONDITIONS, KEPT, ROOT, short, study

SEED = 0


class InPhysics(Resolved):
    """A scenario whose robot moves as its dynamics let it."""

    def plant(
        self, controller: Controller, seed: int, runs: Sequence[int], stream: str = ""
    ) -> Plant:
        its = CONDITIONS["physics"]
        rngs = [generator(seed, stream or self.scenario, run, "disturbances") for run in runs]
        return Plant(
            controller, PhysicsStation(self.arm(controller.robot), its.gears), its.noise, rngs
        )


def prepared() -> tuple[Recording, InPhysics, dict[str, Learner]]:
    """What is recorded, of which arm, and the learners, which have learned nothing yet."""
    job, its = recording(study(), study().scenario), nominal(study(), study().robot)
    damages = assign(its, study().paper_damage, study().seed)[1].damages
    resolved = resolve(job.scenario, its, damages, job.measuring.tests, study().seed)
    arm = InPhysics(**dict(resolved))
    learners = {
        name: build_tuned(
            rules, ROOT / "workflow" / "search" / f"{short(name)}_200.csv", [SEED + 1]
        )
        if rules
        else make_peer(name, 1, arm.controller().robot)
        for name, rules in job.learners.items()
    }
    return job, arm, learners


def main() -> None:
    """Train the study's recorded learners on it, and write what one would have seen."""
    os.chdir(ROOT)  # captions are files of the project
    KEPT.mkdir(parents=True, exist_ok=True)
    job, arm, learners = prepared()
    write_recording(KEPT / "live_paper.rrd", job, arm, learners, {}, SEED)


if __name__ == "__main__":
    main()
