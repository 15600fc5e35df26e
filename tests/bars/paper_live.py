"""The paper's learners and today's identification on an arm in MuJoCo and on kinematics alone.

Robot, damage, learners, poses and searches are those of the study. The controller is untouched, and
both arms are measured with the same noise. Only what moves differs. It writes docs/live_paper.md,
figures/live_paper.png and tables in results/live_paper (15 minutes on 2 cores).

    python -m tests.bars.paper_live
"""

from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import cache
from itertools import product
from pathlib import Path

import jinja2
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from simulated_arm import Gears, PhysicsStation
from simulated_camera import UPWARDS, PicturedStation

from recalib import (
    JOINT_ERRORS,
    OFFSETS,
    Controller,
    DamagedArm,
    Disturbances,
    History,
    Noise,
    Observations,
    Plant,
    load_arm,
    position_error,
    train,
)
from recalib.identification.calibration import calibrate
from recalib.identification.model.error_model import ErrorModel
from recalib.vision import board_pose, find_corners, printable
from replication.config.shipped import OUTCOMES
from replication.config.study import Study
from replication.plots.palette import STYLES
from replication.plots.style import STYLE, logarithmic, save
from replication.running.studies import study_of
from replication.scenarios.resolving import resolve
from replication.training.competitors import label_of, make_peer
from replication.training.poses import Stream
from replication.training.tuned import Tuned

HERE, ROOT = Path(__file__).parent, Path(__file__).parents[2]
KEPT = ROOT / "results" / "live_paper"
PAGE, FIGURE = ROOT / "docs" / "live_paper.md", ROOT / "figures" / "live_paper.png"
SEEDS, TESTS, NOISE = 5, 200, Noise(2e-4, np.radians(0.02))  # m, rad
MAPS, TODAY = ("improved", "ritter"), ("geometric", "hybrid")
ITERATIONS = {MAPS: range(0, 201, 10), TODAY: (0, 5, 10, 20, 30, 50, 100)}
SHOWN = {MAPS: (0, 200), TODAY: (0, 10, 100)}
BOARD = printable(7, 5, 0.05)
SOFT = 3.7e3  # N m/rad, softer than joints in industry: so soft an arm droops by 12 mm
ROUGH = {"friction": 2.0, "play": 3e-4}  # N m, rad
KINEMATICS, NOISY = "kinematics", Disturbances(NOISE)


@dataclass(frozen=True)
class Condition:
    """What moves, and how it is measured.

    Attributes:
        gears: of the arm in MuJoCo; None: kinematics alone.
        learners: that are trained with it.
        reference: the condition with which it is compared.
        scenario: of the study, which has the damage.
        noise: of measured poses.
        other_masses: whether its links have masses other than those of the URDF.
        pictures: whether a camera measures it.
    """

    gears: Gears | None = None
    learners: tuple[str, ...] = (*MAPS, *TODAY)
    reference: str = KINEMATICS
    scenario: str = "links_encoders"
    noise: Disturbances = NOISY
    other_masses: bool = False
    pictures: bool = False


SILENT, MOVED = {"learners": MAPS, "noise": Disturbances()}, "translation_rotation"
CONDITIONS = {
    KINEMATICS: Condition(),
    "physics": Condition(Gears(SOFT)),
    "physics, rough": Condition(Gears(SOFT, **ROUGH)),
    "physics, other masses": Condition(Gears(SOFT), TODAY, other_masses=True),
    "physics, by pictures": Condition(Gears(SOFT), ("improved", "hybrid"), pictures=True),
    "kinematics, no noise": Condition(**SILENT),
    "physics, no noise": Condition(Gears(SOFT), reference="kinematics, no noise", **SILENT),
    "moved, kinematics": Condition(None, ("improved",), scenario=MOVED),
    "moved, physics": Condition(Gears(SOFT), ("improved",), "moved, kinematics", MOVED),
}
CALIBRATED = "physics", "physics, rough", "physics, other masses"
UNSURE = 0.2  # standard deviation of the logarithm of each link's mass, of the arm with others
DRAWS, POSTURES = 10, 30
# Standard deviations of a link's errors along each axis [m, rad], a tenth of a joint's; N m/rad:
# together they make an arm err by 12 mm
LENGTH, ANGLE, STIFF = 4e-4, np.radians(0.04), 7e3
ERRORS = {"position_error_cm": "cm", "orientation_error_deg": "degrees"}
LINES = {KINEMATICS: "--", "physics": "-", "physics, rough": ":"}
TITLES = {MAPS: "The paper's maps", TODAY: "Today's identification"}


@cache
def study() -> Study:
    """That of the replication."""
    return study_of(ROOT, asking=False)


@cache
def scenario(name: str) -> tuple[Controller, DamagedArm]:
    """The controller of the study's robot, and its arm with the damage of a scenario."""
    (resolved,), _ = resolve(study(), study().robot, [name])
    controller = resolved.controller()
    return controller, resolved.arm(controller.robot)


def tuned() -> Tuned:
    """The settings of the study's learners."""
    return Tuned(study(), [ROOT / OUTCOMES])


def with_other_masses(damaged: DamagedArm, seed: int) -> DamagedArm:
    """The same arm with other masses."""
    arm = DamagedArm(damaged.arm.copy(), damaged.offsets)
    factors = np.random.default_rng([seed, 7]).lognormal(sigma=UNSURE, size=arm.arm.model.nv)
    for inertia, factor in zip(list(arm.arm.model.inertias)[1:], factors, strict=True):
        inertia.mass *= factor
        inertia.inertia *= factor
    return arm


class Pictures(Disturbances):
    """Of pictures, in place of poses: the lens and the places of camera and board are known.

    The camera is 1.5 m before the workspace and sees the board anywhere in it.
    """

    def __init__(self, moving: DamagedArm, gears: Gears, centre: np.ndarray, seed: int):
        super().__init__()
        board, camera = UPWARDS.copy(), centre @ UPWARDS
        board[:3, 3] = *(BOARD.size / [-2, 2]), 0.02
        camera[:3, 3] = centre[:3, 3] + 1.5 * centre[:3, 2]
        station = PicturedStation(moving, camera, board, BOARD, KEPT, gears, seed=seed)
        vars(self).update(station=station, camera=camera, tool=np.linalg.inv(board))

    def measure(self, generators, poses: np.ndarray) -> np.ndarray:
        """The pose (1, 1, 4, 4) [m] of the tool after the last move."""
        view = find_corners(BOARD, self.station.picture())
        target = board_pose(BOARD, self.station.lens, view)
        return (self.camera @ target @ self.tool)[None, None]


def plant(condition: Condition, seed: int) -> Plant:
    """The robot behind the untouched controller: its kinematics, or its dynamics."""
    controller, damaged = scenario(condition.scenario)
    noise = condition.noise
    moving = with_other_masses(damaged, seed) if condition.other_masses else damaged
    if condition.pictures:
        noise = Pictures(moving, condition.gears, controller.robot.workspace.centre, seed)
        moving = noise.station
    elif condition.gears is not None:
        moving = PhysicsStation(moving, condition.gears)
    return Plant(controller, moving, noise, [np.random.default_rng([seed, 8])])


def trained(condition: Condition, name: str, seed: int) -> History:
    """A learner's training with the poses of a seed of the study."""
    names = MAPS if name in MAPS else TODAY
    learner = (
        tuned().learner(name, ITERATIONS[MAPS][-1], 1)
        if names == MAPS
        else make_peer(name, 1, scenario(condition.scenario)[0].robot)
    )
    when, options = ITERATIONS[names], {"scenario": condition.scenario}
    poses = Stream.SCENARIO.draw(study().seed, [seed], when[-1], TESTS, **options)
    return train(plant(condition, seed), learner, poses.desired, poses.tests, when)


def curve(job: tuple[str, str, int]) -> pd.DataFrame:
    """The history of a training, with what it is of."""
    condition, learner, seed = job
    table = pd.DataFrame(trained(CONDITIONS[condition], learner, seed).columns())
    return table.assign(condition=condition, learner=learner, seed=seed)


def droop(name: str) -> float:
    """The mean distance [mm] between dynamics and kinematics on the first seed's test poses."""
    condition = CONDITIONS[name]
    controller, damaged = scenario(condition.scenario)
    poses = Stream.SCENARIO.draw(study().seed, [0], 1, TESTS, scenario=condition.scenario)
    angles = controller.targets(poses.tests).angles[0]
    dynamic, _ = plant(condition, 0).achieve(poses.tests)
    return 1e3 * float(position_error(dynamic[0], damaged.forward(angles)).mean())


def calibrated(job: tuple[str, int]) -> dict[str, str | float]:
    """Errors [mm] of an arm in postures anywhere, before and after a calibration from others."""
    name, draw = job
    arm, rng = load_arm("ur10_robot.urdf", "tool0"), np.random.default_rng([draw, 9])
    model, count = ErrorModel(arm, OFFSETS), arm.model.nv
    links = np.repeat([[LENGTH, ANGLE]], 3, axis=1).repeat(count + 1, axis=0)
    errors = np.append(links, np.full(count, 10 * ANGLE))
    errors *= rng.standard_normal(len(errors))
    damaged = DamagedArm(model.arm(errors), errors[-count:])
    condition = CONDITIONS[name]
    real = with_other_masses(damaged, draw) if condition.other_masses else damaged
    moving = PhysicsStation(real, replace(condition.gears, stiffness=STIFF))
    joints = rng.uniform(-np.pi, np.pi, (POSTURES + TESTS, count))
    poses = moving.forward(joints)
    measured = NOISY.measure([rng], poses[None, :POSTURES])[0]
    observations = Observations(joints[:POSTURES], measured)
    predictions = {
        "droop": damaged.forward,
        "before": arm.forward,
        "geometry": calibrate(arm, [OFFSETS], observations).forward,
        "after": calibrate(arm, [OFFSETS, JOINT_ERRORS], observations).forward,
    }
    truth = poses[POSTURES:]
    return {"condition": name, "draw": draw} | {
        stage: 1e3 * float(position_error(forward(joints[POSTURES:]), truth).mean())
        for stage, forward in predictions.items()
    }


def draw_figure(curves: pd.DataFrame) -> None:
    """Both errors over iterations: the mean of the seeds, and all between the least and largest."""
    plt.rcParams.update(STYLE)
    figure, panels = plt.subplots(2, 2, figsize=(9, 8), sharex="col", sharey="row")
    for column, learners in zip(panels.T, ITERATIONS, strict=True):
        for axes, error in zip(column, ERRORS, strict=True):
            for learner, (condition, dashes) in product(learners, LINES.items()):
                rows = curves[(curves.learner == learner) & (curves.condition == condition)]
                errors, style = rows.groupby("iteration")[error], STYLES[learner]
                name = f"{style.label}, {condition}"
                width = 3.5 if learner == "geometric" else 1.5  # visible under the hybrid
                axes.plot(errors.mean(), dashes, color=style.color, linewidth=width, label=name)
                ends = errors.min(), errors.max()
                axes.fill_between(ends[0].index, *ends, color=style.color, alpha=0.15, linewidth=0)
            logarithmic(axes.yaxis, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10)
        best = learners[0] if learners == MAPS else learners[-1]
        ratio = _mean_ratio(curves, best)
        name = f"{label_of(best)} ends\nat {_short(ratio)} times the error of kinematics"
        column[0].set_title(f"{TITLES[learners]}: {name}")
        column[1].legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2)  # hides no curve
        column[1].set_xlabel(f"iterations, of {'two moves' if learners == MAPS else 'one move'}")
    for axes, (error, unit) in zip(panels[:, 0], ERRORS.items(), strict=True):
        axes.set_ylabel(f"{error.split('_')[0]} error [{unit}]")
    shown = "The paper, live: errors with the physics of MuJoCo and with kinematics"
    figure.suptitle(shown, fontweight="bold", x=0.01, ha="left")
    save(figure, FIGURE)


def _mean_ratio(curves: pd.DataFrame, learner: str) -> float:
    """The last position error with physics over that with kinematics, mean over seeds."""
    ends = (_ends(curves, learner, condition) for condition in ("physics", KINEMATICS))
    return float(np.divide(*(end["position_error_cm"] for end in ends)).mean())


def context(curves: pd.DataFrame, draws: pd.DataFrame, droops: pd.DataFrame) -> dict:
    """The context of the template."""
    tables = {}
    for learners, when in SHOWN.items():
        rows = []
        for learner, condition in product(learners, CONDITIONS):
            own = curves[(curves.learner == learner) & (curves.condition == condition)]
            if len(own):
                cells = [_means(own[own.iteration == iteration]) for iteration in when]
                cells[-1] = "; ".join(
                    _spread(own[own.iteration == when[-1]][error]) for error in ERRORS
                )
                rows.append([label_of(learner), condition, *cells])
        tables[TITLES[learners]] = {"when": when, "rows": rows}
    bars = {
        condition: [_spread(rows[name]) for name in ("droop", "before", "geometry", "after")]
        for condition, rows in draws.groupby("condition", sort=False)
    }
    return {
        "seeds": SEEDS,
        "tests": TESTS,
        "draws": DRAWS,
        "postures": POSTURES,
        "unsure": f"{100 * UNSURE:g}",
        "tables": tables,
        "paper": _agreement(curves, "physics"),
        "moved": _agreement(curves, "moved, physics"),
        "bars": bars,
        "droops": dict(zip(droops.condition, droops.droop, strict=True)),
    }


def _agreement(curves: pd.DataFrame, condition: str) -> list[str]:
    """The improved map's last errors, and remaining parts, over those it is compared with."""
    compared = condition, CONDITIONS[condition].reference
    own, reference = (_ends(curves, "improved", name) for name in compared)
    return [_spread(ratio) for _, ratio in (own / reference).items()]


def _ends(curves: pd.DataFrame, learner: str, condition: str) -> pd.DataFrame:
    """A row for each seed: the last errors, and what parts of the first ones they are."""
    own = curves[(curves.learner == learner) & (curves.condition == condition)]
    first, last = (
        own[own.iteration == iteration].set_index("seed") for iteration in (0, own.iteration.max())
    )
    shares = {f"{error}, share": last[error] / first[error] for error in ERRORS}
    return last[[*ERRORS]].assign(**shares)


def _means(rows: pd.DataFrame) -> str:
    return "; ".join(_short(rows[error].mean()) for error in ERRORS)


def _spread(values: pd.Series) -> str:
    return f"{_short(values.mean())} ({_short(values.min())}-{_short(values.max())})"


def _short(value: float) -> str:
    return f"{value:.1f}" if value >= 10 else f"{value:.2f}" if value >= 0.1 else f"{value:.2g}"


def measure() -> None:
    """Make the tables."""
    KEPT.mkdir(parents=True, exist_ok=True)
    jobs = [
        (name, learner, seed)
        for name, condition in CONDITIONS.items()
        for learner, seed in product(condition.learners, range(SEEDS))
    ]
    with ProcessPoolExecutor(2) as pool:
        curves = pd.concat(pool.map(curve, jobs), ignore_index=True)
        curves.to_csv(KEPT / "curves.csv", index=False)
        draws = pd.DataFrame(pool.map(calibrated, product(CALIBRATED, range(DRAWS))))
        draws.to_csv(KEPT / "draws.csv", index=False)
        droops = {"condition": CALIBRATED, "droop": [*pool.map(droop, CALIBRATED)]}
        pd.DataFrame(droops).to_csv(KEPT / "droops.csv", index=False)


def write_page() -> None:
    """Draw the figure and write the page, from the tables."""
    tables = [pd.read_csv(KEPT / f"{name}.csv") for name in ("curves", "draws", "droops")]
    draw_figure(tables[0])
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined, keep_trailing_newline=True)
    template = environment.from_string((HERE / "paper_live.md.j2").read_text(encoding="utf-8"))
    PAGE.write_text(template.render(context(*tables)), encoding="utf-8")


if __name__ == "__main__":
    measure()
    write_page()
