"""What the identification has to show, measured: make laboratory prints the table.

Simulated arms have links off by 1 mm and 0.1 degrees and joints by 1 degree, noise is 0.2 mm and
0.02 degrees, instrument and target are anywhere. With the folder of a real UR5's recording (grid_
1000.csv and random_20.csv) it is measured on that, too.
"""

import argparse
import resource
import time
from collections.abc import Callable
from functools import partial
from itertools import product
from pathlib import Path

import numpy as np

from recalib.errors import RecalibError
from recalib.identification.error_model import OFFSETS, ErrorModel
from recalib.identification.estimation import identify
from recalib.identification.frames import nearest_rotation
from recalib.identification.initial_estimate import initial_frames
from recalib.identification.linearisation import Linearisation
from recalib.identification.observations import Distance, Observations
from recalib.identification.sequence import DRIFT, JUMP, LAG
from recalib.identification.validation import BLOCKWISE, RANDOM, validate
from recalib.nominal.arms import load_arm
from tests.identification.honesty import Session, other_half, three_targets
from tests.identification.real import NOISE, Real

ARMS = {"UR10": ("ur10_robot.urdf", "tool0"), "Panda": ("panda.urdf", "panda_link8")}
RIGHT = 2e-3  # m: an estimate that ends in another valley is off by centimetres
BALL, SOCKETS = np.array([0.02, -0.01, 0.12]), np.array([[0.45, -0.15, 0.1], [0.45, 0.15, 0.1]])
ANGLES = [f"joint_{number}" for number in range(1, 7)]


def seen_of(real: Real, count: int, positions: bool = False) -> Observations:
    joints = real.postures(count)
    poses = real.poses(joints)
    return Observations(joints, poses[:, :3, 3] if positions else poses)


def missed(real: Real, poses: Callable[[np.ndarray], np.ndarray]) -> float:
    """Mean error of position [m] in 200 fresh postures."""
    fresh = real.postures(200)
    gaps = poses(fresh) - real.poses(fresh, noise=(0, 0))
    return float(np.linalg.norm(gaps[:, :3, 3], axis=1).mean())


def frames(name: str, count: int, positions: bool, draws: int) -> str:
    """How often the initial estimate is right, wrong without an error, and refused."""
    arm, right, wrong, refused = load_arm(*ARMS[name]), 0, 0, 0
    for seed in range(draws):
        real = Real(arm, seed)
        observations = seen_of(real, count, positions)
        try:
            model = ErrorModel(arm, OFFSETS, initial_frames(arm, observations))
            estimate = identify(model, observations)
        except RecalibError:
            refused += 1
            continue
        good = missed(real, partial(model.predict, estimate.parameters)) < RIGHT
        right, wrong = right + good, wrong + (not good)
    return f"right {right}, wrong {wrong}, refused {refused} of {draws}"


def least_squares(model: ErrorModel, observations: Observations) -> np.ndarray:
    """Parameters without a prior: of all that fit best, the smallest. It starts at nominal."""
    parameters, terms = np.zeros_like(model.deviations), model.terms(observations.joints)
    for _ in range(10):
        linear = Linearisation(model, parameters, observations, terms)
        scales = np.array(NOISE)[: observations.kinds, None, None]
        rows = (linear.jacobians / scales[..., None]).reshape(-1, len(parameters))
        goal = (linear.residuals / scales).ravel()
        parameters = parameters + np.linalg.lstsq(rows, goal, rcond=1e-7)[0]
    return parameters * model.deviations


def seven_joints(count: int, draws: int) -> str:
    """Ours, and least squares with the noise told, which is what public tools do."""
    arm, ours, plain = load_arm(*ARMS["Panda"]), [], []
    for seed in range(draws):
        real = Real(arm, seed)
        observations = seen_of(real, count)
        model = ErrorModel(arm, OFFSETS, initial_frames(arm, observations))
        for errors, parameters in (
            (ours, identify(model, observations).parameters),
            (plain, least_squares(model, observations)),
        ):
            errors.append(missed(real, partial(model.predict, parameters)))
    return f"{1e3 * np.mean(ours):.3f} mm, least squares {1e3 * np.mean(plain):.3f} mm"


def sockets(draws: int) -> str:
    """Mean errors of the ball in fresh postures, with frames aligned, before and after."""
    arm, before, after = load_arm(*ARMS["Panda"]), [], []
    for seed in range(draws):
        real = Real(arm, seed)
        joints = np.concatenate([real.touching(BALL, socket, 40) for socket in SOCKETS])
        observations = Observations(
            joints, sockets=np.repeat([0, 1], 40), distances=[Distance(0, 1, 0.3)]
        )
        found = validate(arm, observations, initial_frames(arm, observations)).calibration
        fresh = real.postures(200)
        true, tool = real.ball(BALL, fresh), arm.forward(fresh)
        before.append(aligned(tool[:, :3, 3] + tool[:, :3, :3] @ BALL, true))
        after.append(aligned(found.predict(fresh)[:, :3, 3], true))
    ratios = np.array(before) / after
    return (
        f"{1e3 * np.mean(before):.2f} mm to {1e3 * np.mean(after):.2f} mm,"
        f" {ratios.min():.0f} to {ratios.max():.0f} times less"
    )


def aligned(points: np.ndarray, goals: np.ndarray) -> float:
    """The mean distance between points and goals (n, 3) after the best rigid motion."""
    points, goals = points - points.mean(axis=0), goals - goals.mean(axis=0)
    turned = points @ nearest_rotation(goals.T @ points).T
    return float(np.linalg.norm(goals - turned, axis=1).mean())


def recorded(folder: Path, count: int, subsets: int) -> str:
    """The mean error on the 20 poses of the real UR5, frames unknown, and the intervals there."""
    arm, errors, covered, seconds = load_arm("ur5_robot.urdf", "tool0"), [], [], []
    known, tests = (table(folder / name) for name in ("grid_1000.csv", "random_20.csv"))
    for subset in range(subsets):
        rows = np.sort(np.random.default_rng(subset).permutation(len(known))[:count])
        start = time.process_time()
        found = validate(arm, known[rows], initial_frames(arm, known[rows]))
        seconds.append(time.process_time() - start)
        distances = np.linalg.norm(found.calibration.residuals(tests), axis=1)
        errors.append(distances.mean())
        within = np.mean(distances <= found.radius)
        covered.append([found.coverage(RANDOM), found.coverage(BLOCKWISE), within])
    at_random, in_blocks, fresh = 100 * np.mean(covered, axis=0)
    return (
        f"{1e3 * np.mean(errors):.4f} mm; 95 % intervals cover {at_random:.0f} % at random,"
        f" {in_blocks:.0f} % in blocks, {fresh:.0f} % of the 20; {np.mean(seconds):.1f} s"
    )


def table(path: Path) -> Observations:
    rows = np.genfromtxt(path, delimiter=",", names=True)
    measured = [rows[f"{axis}_t"] + rows[f"{axis}_dif"] for axis in "xyz"]
    joints = np.radians(np.stack([rows[name] for name in ANGLES], axis=1))
    return Observations(joints, 1e-3 * np.stack(measured, axis=1))


def several_targets(draws: int) -> str:
    """Said over true errors where a posture has three targets, of geometry and of all of it."""
    arm, ratios = load_arm(*ARMS["UR10"]), []
    for seed in range(draws):
        ratios.append([said / true for said, true in three_targets(arm, seed).values()])
    low, high = np.min(ratios, axis=0), np.max(ratios, axis=0)
    return f"geometry {low[0]:.2f} to {high[0]:.2f}, all of it {low[1]:.2f} to {high[1]:.2f}"


def halves(draws: int) -> str:
    """The part of positions within the radius where nobody measured."""
    within = [other_half(load_arm(*ARMS["UR10"]), seed) for seed in range(draws)]
    return f"{100 * np.mean(within):.1f} % on average, {100 * np.min(within):.0f} % at least"


def sessions(kind: str, size: float, draws: int) -> str:
    """How often a fault of a session is named; how honest errors are where it is not."""
    arm, named, ratios = load_arm(*ARMS["UR10"]), 0, []
    for seed, positions, on_a_path in product(range(draws), (False, True), (False, True)):
        session = Session(arm, seed, kind, size, positions, on_a_path)
        if kind in [fault.kind for fault in session.named()]:
            named += 1
        else:
            ratios.append(session.honesty())
    unnamed = f"; otherwise said over true error at least {min(ratios):.2f}" if ratios else ""
    return f"named in {named} of {4 * draws}{unnamed}"


def many(count: int) -> str:
    """Time and memory for many positions, of an arm with waves in its joints."""
    arm = load_arm(*ARMS["UR10"])
    real = Real(arm, 1)
    joints = real.postures(count)
    waves = 2e-3 * np.sin(joints) + 1e-3 * np.cos(2 * joints)
    observations = Observations(joints, real.poses(joints + waves)[:, :3, 3])
    start = time.process_time()
    found = validate(arm, observations, initial_frames(arm, observations))
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    return f"{found.chosen}, {time.process_time() - start:.1f} s, {memory:.2f} GB in all"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draws", type=int, default=100)
    parser.add_argument("--only", default="", help="rows whose names begin like that")
    parser.add_argument("--recording", type=Path, help="folder of the real UR5's two tables")
    options = parser.parse_args()
    rows = [
        (f"frames, {name}, {count} {what}", partial(frames, name, count, positions, options.draws))
        for name in ARMS
        for what, count, positions in (("poses", 20, False), ("positions", 30, True))
    ]
    rows += [
        ("7 joints, 30 poses", partial(seven_joints, 30, min(20, options.draws))),
        ("ball in two sockets", partial(sockets, min(5, options.draws))),
    ]
    few, arms = min(10, options.draws), min(20, options.draws)
    rows += [
        ("three targets a posture", partial(several_targets, few)),
        ("measured in one half", partial(halves, arms)),
        ("a lag of 1 %", partial(sessions, LAG, 0.01, few)),
        ("a lag of 5 %", partial(sessions, LAG, 0.05, few)),
        ("two sessions 1 mm apart", partial(sessions, JUMP, 1e-3, few)),
        ("a drift of 1 mm", partial(sessions, DRIFT, 1e-3, few)),
    ]
    if options.recording:
        rows += [
            (f"real UR5, {count} positions", partial(recorded, options.recording, count, subsets))
            for count, subsets in ((1000, 1), (100, 20), (20, 20))
        ]
    rows.append(("10,000 positions", partial(many, 10_000)))
    for name, measure in rows:
        if not name.startswith(options.only):
            continue
        print(f"{name:<32}{measure()}", flush=True)


if __name__ == "__main__":
    main()
