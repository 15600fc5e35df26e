"""A film of the paper, live: an arm in MuJoCo misses three poses, learns, and hits them.

python -m tests.bars.film
"""

import mujoco
import numpy as np
from PIL import Image, ImageDraw, ImageFont
from simulated_arm import PhysicsStation

from recalib import Plant, position_error
from replication.training.poses import Stream
from tests.bars.paper_live import CONDITIONS, FIGURE, NOISY, scenario, study, tuned

FILM, SIZE = FIGURE.with_suffix(".webp"), (640, 480)
LEARNER, SHOWN, GOALS = "improved", (0, 5, 20, 200), 3
EVERY, LINGER, PACE = 12, 12, 60  # steps from a picture to the next; pictures at a goal; ms of each
ORANGE, GREEN = [0.84, 0.37, 0, 1], [0, 0.62, 0.45, 0.5]


class Filmed(PhysicsStation):
    """A station that is filmed while `caption` is set."""

    caption, goal = "", np.eye(4)

    def __init__(self, *arguments, **options):
        self.frames, self._held = [], 0
        super().__init__(*arguments, **options)
        self._renderer = mujoco.Renderer(self._model, *SIZE[::-1])
        self._view = mujoco.MjvCamera()
        self._view.lookat[:] = 0.4, 0.1, 0.47
        self._view.distance, self._view.azimuth, self._view.elevation = 1.3, 120, -18

    def _scene(self, spec):
        spec.visual.headlight.ambient, spec.visual.headlight.diffuse = [0.5] * 3, [0.5] * 3
        sky, even = mujoco.mjtTexture.mjTEXTURE_SKYBOX, mujoco.mjtBuiltin.mjBUILTIN_FLAT
        spec.add_texture(
            type=sky, builtin=even, rgb1=[0.93] * 3, rgb2=[0.93] * 3, width=32, height=32
        )
        return super()._scene(spec)

    def _hold(self, angles, missed=0.0):
        super()._hold(angles, missed)
        self._held += 1
        if self.caption and self._held % EVERY == 0:
            self.frames.append(self.frame())

    def frame(self) -> Image.Image:
        """The arm, the desired position (green), the tool (orange), and what they are."""
        self._renderer.update_scene(self._data, camera=self._view)
        scene = self._renderer.scene
        balls = (self.pose()[:3, 3], 0.028, ORANGE), (self.goal[:3, 3], 0.035, GREEN)
        for place, radius, color in balls:
            geom = scene.geoms[scene.ngeom]
            shape, size = mujoco.mjtGeom.mjGEOM_SPHERE, np.full(3, radius)
            mujoco.mjv_initGeom(geom, shape, size, place, np.eye(3).ravel(), np.array(color, "f4"))
            scene.ngeom += 1
        picture = Image.fromarray(self._renderer.render())
        caption = f"improved map {self.caption}\ngreen: desired, orange: tool"
        ImageDraw.Draw(picture).text((16, 12), caption, "black", ImageFont.load_default(20))
        return picture


def main() -> None:
    """Train, and film on the way."""
    condition, (controller, damaged) = CONDITIONS["physics"], scenario(study().scenario)
    workspace = controller.robot.workspace
    station = Filmed(damaged, condition.gears)
    plant = Plant(controller, station, NOISY, [np.random.default_rng(0)])
    learner = tuned().learner(LEARNER, SHOWN[-1], 1)
    poses = Stream.SCENARIO.draw(study().seed, [0], SHOWN[-1], GOALS, scenario=condition.scenario)
    goals = workspace.to_poses(poses.tests[0])
    for iteration in range(SHOWN[-1] + 1):
        if iteration in SHOWN:
            for number, goal in enumerate(goals):
                desired = poses.tests[:, [number]]
                station.goal, station.caption = goal, f"after {iteration} iterations"
                reached = plant.achieve(learner.command(desired))[0][0]
                miss = 1e3 * position_error(reached, goal[None])[0]
                station.caption += f": off by {miss:.0f} mm"
                station.frames += [station.frame()] * LINGER
            station.caption = ""
        if iteration < SHOWN[-1]:
            learner.learn(poses.desired[:, iteration], plant.execute, iteration / SHOWN[-1])
    first, *others = station.frames
    film = {"save_all": True, "append_images": others, "duration": PACE, "loop": 0}
    first.save(FILM, quality=60, method=4, **film)


if __name__ == "__main__":
    main()
