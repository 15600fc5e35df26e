"""The paper's learners and today's identification on an arm in MuJoCo, beside the same kinematics.

Robot, damage, learners, poses and searches are those of the study. The controller is untouched, and
both arms are measured with the same noise. Only what moves differs. It writes docs/live_paper.md,
figures/live_paper.png and tables in results/live_paper (6 minutes on 2 cores).

    python -m tests.station.paper_live
"""

from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path

import jinja2
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

from recalib.damaged.damage import DamagedArm, apply
from recalib.damaged.disturbances import Disturbances, Noise
from recalib.damaged.plant import Plant
from recalib.identification.calibration import calibrate
from recalib.identification.error_model import JOINT_ERRORS, OFFSETS, ErrorModel
from recalib.identification.observations import Observations
from recalib.loop.training import History, train
from recalib.nominal.arms import load_arm
from recalib.nominal.controller import Controller
from recalib.nominal.poses import position_error
from recalib.station.camera import UPWARDS, PicturedStation
from recalib.station.physics import Gears, PhysicsStation
from recalib.study.configuration.damages import damages_among
from recalib.study.configuration.study import Study
from recalib.study.experiments.poses import Stream
from recalib.study.experiments.settings import build_tuned
from recalib.study.plan.competitors import COMPETITORS, label_of, make_peer
from recalib.study.plan.trainings import rules
from recalib.study.plots.style import STYLE, logarithmic, save
from recalib.study.scenarios.assignments import assign
from recalib.study.scenarios.nominal import nominal
from recalib.study.scenarios.plants import nominal_controller
from recalib.study.studies import read_studies
from recalib.vision.boards import printable
from recalib.vision.detection import find_corners
from recalib.vision.views import board_pose

HERE, ROOT = Path(__file__).parent, Path(__file__).parents[2]
KEPT = ROOT / "results" / "live_paper"
PAGE, FIGURE = ROOT / "docs" / "live_paper.md", ROOT / "figures" / "live_paper.png"
SEEDS, TESTS, NOISE = 5, 200, Noise(2e-4, np.radians(0.02))  # m, rad
MAPS, TODAY = ("improved_200", "ritter_200"), ("geometric", "hybrid")
ITERATIONS = {MAPS: range(0, 201, 10), TODAY: (0, 5, 10, 20, 30, 50, 100)}
SHOWN = {MAPS: (0, 10, 50, 100, 200), TODAY: (0, 10, 20, 30, 100)}
KINEMATICS, MASSES, PICTURES = "kinematics", "physics, other masses", "physics, by pictures"
BOARD = printable("charuco", 7, 5, 0.05)
SOFT = 3.7e3  # N m/rad, softer than joints in industry: so soft an arm droops by 12 mm
PHYSICS = {
    "physics": Gears(SOFT),
    "physics, rough": Gears(SOFT, friction=2.0, play=3e-4),
    MASSES: Gears(SOFT),
    PICTURES: Gears(SOFT),
}
LEARNERS = dict.fromkeys((KINEMATICS, *PHYSICS), (*MAPS, *TODAY))
LEARNERS |= {MASSES: TODAY, PICTURES: ("improved_200", "hybrid")}  # a picture takes 0.3 s
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
    root, studies = read_studies(ROOT, [], {}, asking=False)
    return studies[root]


@cache
def scenario() -> tuple[Controller, DamagedArm]:
    """The controller of the study's robot, and the arm with the paper's damage."""
    its = nominal(study(), study().robot)
    _, assignment = assign(its, study().paper_damage, study().seed)
    controller = nominal_controller(its)
    return controller, apply(controller.robot, damages_among(assignment.damages))


def short(learner: str) -> str:
    """Its name without the number of its iterations."""
    return learner.removesuffix("_200")


def station(damaged: DamagedArm, condition: str, gears: Gears, seed: int) -> PhysicsStation:
    """The arm in MuJoCo, with masses of its own where the condition is so."""
    its = DamagedArm(damaged.arm.copy(), damaged.offsets)
    if condition == MASSES:
        factors = np.exp(
            MASSES * np.random.default_rng([seed, 7]).standard_normal(its.arm.model.nv)
        )
        for inertia, factor in zip(list(its.arm.model.inertias)[1:], factors, strict=True):
            inertia.mass *= factor
            inertia.inertia *= factor
    return PhysicsStation(its, gears)


class Pictures(Disturbances):
    """Of pictures, in place of poses: the lens and the places of camera and board are known.

    The camera is 1.5 m before the workspace and sees the board anywhere in it.
    """

    def __init__(self, moving: DamagedArm, gears: Gears, centre: np.ndarray, seed: int):
        super().__init__()
        place, camera = UPWARDS.copy(), centre @ UPWARDS
        place[:3, 3] = *(BOARD.size / [-2, 2]), 0.02
        camera[:3, 3] = centre[:3, 3] + 1.5 * centre[:3, 2]
        station = PicturedStation(moving, camera, place, BOARD, KEPT, gears, seed=seed)
        vars(self).update(station=station, before=camera, behind=np.linalg.inv(place))

    def measure(self, generators, poses: np.ndarray) -> np.ndarray:
        """The pose (1, 1, 4, 4) [m] of the tool after the last move."""
        view = find_corners(BOARD, self.station.picture())
        seen = board_pose(BOARD, self.station.lens, view)
        return (self.before @ seen @ self.behind)[None, None]


def plant(condition: str, seed: int) -> Plant:
    """The robot behind the untouched controller: its kinematics, or its dynamics."""
    controller, damaged = scenario()
    rngs = [np.random.default_rng([seed, 8])]
    if condition == KINEMATICS:
        return Plant(controller, damaged, Disturbances(NOISE), rngs)
    if condition == PICTURES:
        centre = controller.robot.workspace.centre
        pictures = Pictures(damaged, PHYSICS[condition], centre, seed)
        return Plant(controller, pictures.station, pictures, rngs)
    moving = station(damaged, condition, PHYSICS[condition], seed)
    return Plant(controller, moving, Disturbances(NOISE), rngs)


def trained(condition: str, learner: str, seed: int) -> History:
    """A learner's training with the poses, and the search's winner, of a seed of the study."""
    controller, _ = scenario()
    iterations, when = 100, ITERATIONS[TODAY]
    if learner in MAPS:
        iterations, when = 200, ITERATIONS[MAPS]
        sample = ROOT / "workflow" / "search" / f"{learner}.csv"
        its = build_tuned(rules(study(), learner), sample, [seed + 1])
    else:
        its = make_peer(learner, 1, controller)
    poses = Stream.SCENARIO.draw(study().seed, [seed], iterations, TESTS, scenario=study().scenario)
    return train(plant(condition, seed), its, poses.desired, poses.tests, when)


def curve(job: tuple[str, str, int]) -> pd.DataFrame:
    """The history of a training, with what it is of."""
    condition, learner, seed = job
    table = pd.DataFrame(trained(*job).columns()).drop(columns="run")
    return table.assign(condition=condition, learner=learner, seed=seed)


def droop(condition: str) -> float:
    """The mean distance [mm] between dynamics and kinematics on the first seed's test poses."""
    controller, damaged = scenario()
    poses = Stream.SCENARIO.draw(study().seed, [0], 1, TESTS, scenario=study().scenario)
    angles = controller.targets(poses.tests).angles[0]
    moving = station(damaged, condition, PHYSICS[condition], 0)
    return 1e3 * float(position_error(moving.forward(angles), damaged.forward(angles)).mean())


def calibrated(job: tuple[str, int]) -> dict[str, str | float]:
    """Errors [mm] of an arm in postures anywhere, before and after a calibration from others."""
    condition, draw = job
    arm, rng = load_arm("ur10_robot.urdf", "tool0"), np.random.default_rng([draw, 9])
    model, count = ErrorModel(arm, OFFSETS), arm.model.nv
    links = np.repeat([[LENGTH, ANGLE]], 3, axis=1).repeat(count + 1, axis=0)
    errors = np.append(links, np.full(count, 10 * ANGLE))
    errors *= rng.standard_normal(len(errors))
    damaged = DamagedArm(model.arm(errors), errors[-count:])
    moving = station(damaged, condition, replace(PHYSICS[condition], stiffness=STIFF), draw)
    joints = rng.uniform(-np.pi, np.pi, (POSTURES + TESTS, count))
    poses = moving.forward(joints)
    measured = Disturbances(NOISE).measure([rng], poses[None, :POSTURES])[0]
    observations = Observations(joints[:POSTURES], measured)
    predictions = {
        "droop": damaged.forward,
        "before": arm.forward,
        "geometry": calibrate(arm, [OFFSETS], observations).forward,
        "after": calibrate(arm, [OFFSETS, JOINT_ERRORS], observations).forward,
    }
    truth = poses[POSTURES:]
    return {"condition": condition, "draw": draw} | {
        name: 1e3 * float(position_error(forward(joints[POSTURES:]), truth).mean())
        for name, forward in predictions.items()
    }


def drawn(curves: pd.DataFrame) -> None:
    """Both errors over iterations: the mean of the seeds, and all between the least and largest."""
    plt.rcParams.update(STYLE)
    figure, panels = plt.subplots(2, 2, figsize=(9, 7), sharex="col", sharey="row")
    for column, learners in zip(panels.T, ITERATIONS, strict=True):
        for axes, error in zip(column, ERRORS, strict=True):
            for learner, (condition, dashes) in product(learners, LINES.items()):
                rows = curves[(curves.learner == learner) & (curves.condition == condition)]
                errors, style = rows.groupby("iteration")[error], COMPETITORS[short(learner)]
                name = f"{style.label}, {condition}"
                axes.plot(errors.mean(), color=style.color, linestyle=dashes, label=name)
                ends = errors.min(), errors.max()
                axes.fill_between(ends[0].index, *ends, color=style.color, alpha=0.15, linewidth=0)
            logarithmic(axes.yaxis, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10)
        column[0].set_title(TITLES[learners])
        column[1].legend(fontsize=8)
        column[1].set_xlabel(f"iterations, of {'two moves' if learners == MAPS else 'one move'}")
    for axes, (error, unit) in zip(panels[:, 0], ERRORS.items(), strict=True):
        axes.set_ylabel(f"mean {error.split('_')[0]} error, test poses [{unit}]")
    save(figure, FIGURE)


def context(curves: pd.DataFrame, draws: pd.DataFrame, droops: pd.DataFrame) -> dict:
    """What the page says."""
    tables, ratios = {}, {}
    for learners, when in SHOWN.items():
        rows = []
        for learner, condition in product(learners, (KINEMATICS, *PHYSICS)):
            own = curves[(curves.learner == learner) & (curves.condition == condition)]
            if len(own):
                cells = [_both(own[own.iteration == iteration]) for iteration in when]
                rows.append([label_of(short(learner)), condition, *cells])
        tables[TITLES[learners]] = {"when": when, "rows": rows}
        last = curves[curves.iteration == when[-1]].set_index(["learner", "condition", "seed"])
        for learner, condition in product(learners, PHYSICS):
            if (learner, condition) in last.index:
                own, kinematic = (last.loc[learner, its] for its in (condition, KINEMATICS))
                ratios[label_of(short(learner)), condition] = [
                    _spread(own[error] / kinematic[error]) for error in ERRORS
                ]
    bars = {
        condition: [_spread(rows[name], 3) for name in ("droop", "before", "geometry", "after")]
        for condition, rows in draws.groupby("condition", sort=False)
    }
    numbers = {"seeds": SEEDS, "tests": TESTS, "draws": DRAWS, "postures": POSTURES}
    return numbers | {
        "tables": tables,
        "ratios": ratios,
        "bars": bars,
        "droops": dict(zip(droops.condition, droops.droop, strict=True)),
    }


def _both(rows: pd.DataFrame) -> str:
    position, orientation = (_spread(rows[error]) for error in ERRORS)
    return f"{position}; {orientation}"


def _spread(values: pd.Series, digits: int = 2) -> str:
    low, mean, high = (
        f"{its:#.{digits}g}".rstrip(".") for its in (values.min(), values.mean(), values.max())
    )
    return f"{mean} ({low}-{high})"


def measured() -> None:
    """Make the tables."""
    KEPT.mkdir(parents=True, exist_ok=True)
    trainings = [(condition, name) for condition, names in LEARNERS.items() for name in names]
    jobs = [(*training, seed) for training, seed in product(trainings, range(SEEDS))]
    told = [name for name in PHYSICS if name != PICTURES]
    with ProcessPoolExecutor(2) as pool:
        curves = pd.concat(pool.map(curve, jobs), ignore_index=True)
        curves.to_csv(KEPT / "curves.csv", index=False)
        draws = pd.DataFrame(pool.map(calibrated, product(told, range(DRAWS))))
        draws.to_csv(KEPT / "draws.csv", index=False)
        droops = pd.DataFrame({"condition": told, "droop": [*pool.map(droop, told)]})
        droops.to_csv(KEPT / "droops.csv", index=False)


def written() -> None:
    """Draw the figure and write the page, from the tables."""
    tables = [pd.read_csv(KEPT / f"{name}.csv") for name in ("curves", "draws", "droops")]
    drawn(tables[0])
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined, keep_trailing_newline=True)
    template = environment.from_string((HERE / "paper_live.md.j2").read_text(encoding="utf-8"))
    PAGE.write_text(template.render(context(*tables)), encoding="utf-8")


if __name__ == "__main__":
    measured()
    written()
