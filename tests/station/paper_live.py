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

HERE, ROOT = Path(__file__).parent, Path(__file__).parents[2]
KEPT = ROOT / "results" / "live_paper"
PAGE, FIGURE = ROOT / "docs" / "live_paper.md", ROOT / "figures" / "live_paper.png"
SEEDS, TESTS, NOISE = 5, 200, Noise(2e-4, np.radians(0.02))  # m, rad
MAPS, TODAY = ("improved_200", "ritter_200"), ("geometric", "hybrid")
ITERATIONS = {MAPS: range(0, 201, 10), TODAY: (0, 5, 10, 20, 30, 50, 100)}
SHOWN = {MAPS: (0, 10, 50, 100, 200), TODAY: (0, 10, 20, 30, 100)}
KINEMATICS = "kinematics"
SOFT = (
    3.7e3  # N m/rad: softer than an industrial arm's joints, so that droop is as large as asked for
)
PHYSICS = {
    "physics": Gears(SOFT),
    "physics, rough": Gears(SOFT, friction=2.0, play=3e-4),
    "physics, other masses": Gears(SOFT),
}
MASSES = 0.2  # standard deviation of the logarithm of each link's mass, of the arm with others
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
    if "masses" in condition:
        factors = np.exp(
            MASSES * np.random.default_rng([seed, 7]).standard_normal(its.arm.model.nv)
        )
        for inertia, factor in zip(list(its.arm.model.inertias)[1:], factors, strict=True):
            inertia.mass *= factor
            inertia.inertia *= factor
    return PhysicsStation(its, gears)


def plant(condition: str, seed: int) -> Plant:
    """The robot behind the untouched controller: its kinematics, or its dynamics."""
    controller, damaged = scenario()
    moving = (
        damaged
        if condition == KINEMATICS
        else station(damaged, condition, PHYSICS[condition], seed)
    )
    return Plant(controller, moving, Disturbances(NOISE), [np.random.default_rng([seed, 8])])


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


def context(curves: pd.DataFrame, draws: pd.DataFrame, droops: dict[str, float]) -> dict:
    """What the page says."""
    tables = {}
    for learners, when in SHOWN.items():
        rows = []
        for learner, condition in product(learners, (KINEMATICS, *PHYSICS)):
            of = curves[(curves.learner == learner) & (curves.condition == condition)]
            cells = [_both(of[of.iteration == iteration]) for iteration in when]
            rows.append([label_of(short(learner)), condition, *cells])
        tables[TITLES[learners]] = {"when": when, "rows": rows}
    last = curves[
        curves.iteration
        == curves.learner.map({name: its[-1] for names, its in SHOWN.items() for name in names})
    ]
    pairs = last.set_index(["learner", "condition", "seed"]).position_error_cm.unstack("condition")
    ratios = {
        (label_of(short(learner)), condition): _spread(
            pairs.loc[learner][condition] / pairs.loc[learner][KINEMATICS]
        )
        for learner in (*MAPS, *TODAY)
        for condition in PHYSICS
    }
    bars = {
        condition: [_spread(rows[name]) for name in ("droop", "before", "geometry", "after")]
        for condition, rows in draws.groupby("condition", sort=False)
    }
    numbers = {"seeds": SEEDS, "tests": TESTS, "draws": DRAWS, "postures": POSTURES}
    return numbers | {
        "tables": tables,
        "ratios": ratios,
        "bars": bars,
        "droops": {name: f"{droop:.1f}" for name, droop in droops.items()},
    }


def _both(rows: pd.DataFrame) -> str:
    return "; ".join(f"{_spread(rows[error])}" for error in ERRORS)


def _spread(values: pd.Series) -> str:
    return f"{values.mean():.2g} ({values.min():.2g}-{values.max():.2g})"


def main() -> None:
    """Measure, and write the tables, the figure and the page."""
    KEPT.mkdir(parents=True, exist_ok=True)
    conditions = KINEMATICS, *PHYSICS
    with ProcessPoolExecutor(2) as pool:
        jobs = product(conditions, (*MAPS, *TODAY), range(SEEDS))
        curves = pd.concat(pool.map(curve, jobs), ignore_index=True)
        draws = pd.DataFrame(pool.map(calibrated, product(PHYSICS, range(DRAWS))))
        droops = dict(zip(PHYSICS, pool.map(droop, PHYSICS), strict=True))
    curves.to_csv(KEPT / "curves.csv", index=False)
    draws.to_csv(KEPT / "draws.csv", index=False)
    drawn(curves)
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined, keep_trailing_newline=True)
    template = environment.from_string((HERE / "paper_live.md.j2").read_text(encoding="utf-8"))
    PAGE.write_text(template.render(context(curves, draws, droops)), encoding="utf-8")


if __name__ == "__main__":
    main()
