"""All that an identification says of synthetic arms, as it is kept in files."""

from dataclasses import replace

import numpy as np
import pytest

from recalib.damaged.damage import apply
from recalib.damaged.disturbances import Disturbances, Noise
from recalib.damaged.nongeometric import EccentricGear, Sag
from recalib.errors import RecalibError
from recalib.identification import estimation
from recalib.identification.calibration import (
    Calibration,
    calibrate,
)
from recalib.identification.checks.diagnostics import check_estimate, check_postures
from recalib.identification.checks.identifiability import unidentifiable_parameters
from recalib.identification.checks.postures import find_postures
from recalib.identification.checks.sequence import DRIFT, JUMP, LAG
from recalib.identification.closed_forms import solutions
from recalib.identification.consensus import _by_chance, identify_by_consensus
from recalib.identification.design import information_gains, most_informative
from recalib.identification.estimation import identify
from recalib.identification.initial_estimate import fewest, initial_frames, median_error
from recalib.identification.model.error_model import (
    JOINT_ERRORS,
    JOINT_WAVES,
    NO_ERRORS,
    OFFSETS,
    ErrorModel,
    held,
)
from recalib.identification.model.frames import Frames
from recalib.identification.model.linearisation import Linearisation
from recalib.identification.model.observations import Distance, Observations
from recalib.identification.parameters import parameters_of
from recalib.identification.validation import KINDS, WAYS, validate
from recalib.learners.geometric import angles_for
from recalib.nominal.arms import load_arm
from recalib.numerics.randomness import generator
from tests.arms import RAILED, urdf
from tests.identification.honesty import Session
from tests.identification.real import Real, anywhere
from tests.kept import plain

BALL = np.array([0.02, -0.01, 0.12])
SMALL = urdf(
    ("swing", "revolute", "0 0 1", "0 0 0.3"),
    ("lift", "revolute", "0 1 0", "0.05 0 0.1"),
    ("turn", "revolute", "1 0 0", "0.3 0 0"),
    ("still", "revolute", "0 1 0", "0.2 0.03 0.01"),
    ("flange", "fixed", "0 0 1", "0.15 0 0.02"),
    mass=3.0,
)
SOCKETS = np.array([[0.45, -0.15, 0.1], [0.5, 0.2, 0.15]])


def coarse(numbers, digits: int = 4):
    """Rounded by the largest of them: so exact is what an iteration ends at."""
    numbers = np.asarray(numbers, dtype=float)
    largest = np.abs(numbers).max(initial=1e-300)
    return np.round(numbers, digits - int(np.floor(np.log10(largest))))


@pytest.fixture(scope="module")
def arm():
    return load_arm("ur10_robot.urdf", "tool0")


def measured(arm, kind: str, rows: int = 30) -> Observations:
    """Of a synthetic arm, with one row that is off."""
    real = Real(arm, 3, targets=2 if kind == "targets" else 1)
    if kind == "sockets":
        joints = np.concatenate([real.touching(BALL, socket, rows) for socket in SOCKETS])
        distance = float(np.linalg.norm(SOCKETS[0] - SOCKETS[1]))
        return Observations(
            joints, sockets=np.repeat([0, 1], rows), distances=[Distance(0, 1, distance + 1e-4)]
        )
    joints = real.postures(rows)
    targets = np.arange(rows) % 2 if kind == "targets" else None
    poses = real.poses(joints, 0 if targets is None else targets)
    poses[5, :3, 3] += 0.004, -0.003, 0.002
    return Observations(joints, poses if kind == "poses" else poses[:, :3, 3], targets)


def of_frames(frames: Frames) -> dict:
    numbers = {name: coarse(getattr(frames, name)) for name in ("base", "targets", "sockets")}
    return vars(frames) | {name: its.ravel() if its.size else None for name, its in numbers.items()}


def of_estimate(model: ErrorModel, estimate) -> dict:
    """All of it, in the units of people."""
    return {
        "parameters": [
            [its.name, its.unit, *np.round([its.value, its.deviation], 3).tolist()]
            for its in parameters_of(model, estimate)
            if abs(its.value) > 0.05
        ],
        "values": coarse(estimate.parameters),
        "deviations": coarse(np.sqrt(np.diag(estimate.covariance))),
        "covariance": coarse(estimate.covariance, 3),
        "noise": coarse(estimate.noise),
        "weights": np.round(estimate.weights, 3),
        "log evidence": round(estimate.log_evidence, 2),
        "converged": estimate.converged,
    }


def of_calibration(calibration: Calibration, observations: Observations) -> dict:
    joints, targets = observations.joints + 0.01, observations.targets
    jacobians = calibration.predict_and_jacobian(joints, targets)[1]
    again = Calibration.restore(calibration.model.nominal, calibration.state())
    return of_estimate(calibration.model, calibration.estimate) | {
        "terms": calibration.model.names,
        "frames": of_frames(calibration.frames),
        "forward": coarse(calibration.forward(joints)),
        "jacobians": coarse(calibration.forward_and_jacobian(joints)[1]),
        "predicted": coarse(calibration.predict(joints, targets)),
        "of the first": coarse(calibration.predict(joints)),
        "predicted jacobians": coarse(jacobians),
        "residuals": np.round(1e3 * calibration.residuals(observations), 3),
        "pattern": calibration.pattern is not None,
        "again": coarse(again.forward(joints)),
        "count": len(calibration.parameters),
        "said": calibration.summary().splitlines()[2:8],
    }


@pytest.mark.parametrize("name", ["ur10", "railed"])
@pytest.mark.parametrize("terms", ["none", "offsets", "errors", "waves"])
def test_what_an_error_model_computes_is_as_kept(name, terms, arm, load, data_regression):
    nominal = arm if name == "ur10" else load(RAILED)
    its = {"none": NO_ERRORS, "offsets": OFFSETS, "errors": JOINT_ERRORS, "waves": JOINT_WAVES}
    rng = np.random.default_rng(4)
    ends = anywhere(rng, 1.0), np.array([anywhere(rng, 0.1), anywhere(rng, 0.1)])
    frames = {
        "none": Frames(*ends, base_unknown=True, targets_unknown=True),
        "offsets": Frames(),
        "errors": Frames(ends[0], ends[1][:1], rng.normal(size=(2, 3)), base_unknown=True),
        "waves": Frames(*ends, target_deviations=(0.3, 0.2), targets_unknown=True),
    }[terms]
    count = len(nominal.joints)
    still = np.arange(count) == 2
    model = ErrorModel(nominal, held(its[terms], still) if terms == "waves" else its[terms], frames)
    parameters = model.deviations * rng.normal(size=len(model.deviations))
    joints = rng.uniform(-1, 1, (5, count))
    targets = np.arange(5) % len(frames.targets)
    by_term = model.terms(joints)
    poses, jacobians = model.linearise(parameters, joints, by_term, targets)
    found = {
        "names": len(model.names),
        "deviations": model.deviations,
        "free": model.free,
        "size": model.size,
        "columns": [[its.start, its.stop] for its in (model.socket_columns, model.offset_columns)],
        "twists": model.twists(parameters),
        "sockets": model.sockets(parameters),
        "coefficients": model.coefficients(parameters),
        "terms": by_term,
        "standing": model.standing(parameters, joints, by_term),
        "poses": poses,
        "predicted": [model.predict(parameters, joints, its) for its in (None, targets)],
        "jacobians": jacobians,
        "own": model.own_arm(parameters).forward(joints),
        "arms": [model.arm(parameters, its).forward(joints) for its in range(len(frames.targets))],
        "found": vars(model.found(parameters)),
    }
    found["coefficients"] = [*found["coefficients"].values()][:5]
    data_regression.check(plain(found))


@pytest.mark.parametrize("kind", ["poses", "positions", "targets", "sockets"])
def test_what_is_identified_from_each_kind_of_rows_is_as_kept(kind, arm, panda, data_regression):
    nominal = panda if kind == "sockets" else arm
    observations = measured(nominal, kind)
    frames, tool = initial_frames(nominal, observations), nominal.forward(observations.joints)
    model = ErrorModel(nominal, OFFSETS, frames)
    calibration = Calibration(model, identify(model, observations))
    weights = np.random.default_rng(2).uniform(size=len(observations))
    found = {
        "initial": of_frames(frames),
        "closed": [of_frames(its) for its in solutions(tool, observations)],
        "fewest": fewest(observations),
        "error": coarse(median_error(frames, tool, observations)),
        "calibration": of_calibration(calibration, observations),
        "by other weights": coarse(identify(model, observations, weights=weights).noise, 3),
        "unidentifiable": [
            replace(one, partners=sorted(one.partners))
            for one in unidentifiable_parameters(calibration, observations)
        ],  # rounding decides their order where several are as strong
        "gains": coarse(information_gains(calibration, observations.joints)),
        "telling": [best for best, _ in most_informative(calibration, observations.joints, 4)],
        "told": [
            coarse(its, 3) for _, its in most_informative(calibration, observations.joints, 2)
        ],
    }
    data_regression.check(plain(found))


@pytest.mark.parametrize("known", ["base", "target", "both"])
@pytest.mark.parametrize("kind", ["poses", "positions"])
def test_frames_of_which_one_is_known_are_as_kept(kind, known, arm, data_regression):
    real, rows = Real(arm, 5), 24
    joints = real.postures(rows)
    poses = real.poses(joints)
    observations = Observations(joints, poses if kind == "poses" else poses[:, :3, 3])
    given = {"base": real.base, "target": real.targets[0]}
    given = given if known == "both" else {known: given[known]}
    tool = arm.forward(joints)
    raw = [of_frames(its) for its in solutions(tool, observations, **given)]
    frames = initial_frames(arm, observations, **given)
    model = ErrorModel(arm, JOINT_ERRORS, frames)
    parameters = 0.3 * model.deviations * np.random.default_rng(6).normal(size=len(model.free))
    linear = Linearisation(model, parameters / model.deviations, observations, model.terms(joints))
    weights = np.where(np.arange(rows) % 5 == 2, 0.3, 1.0)
    before = [linear.residuals, linear.jacobians, linear.reach, linear.normal_equations(weights)]
    linear.move(0.01 * np.sin(np.arange(len(parameters))))
    estimate = identify(model, observations)
    found = [raw, of_frames(frames), before, linear.residuals, of_estimate(model, estimate)]
    data_regression.check(plain(found))


@pytest.mark.parametrize("terms", [OFFSETS, JOINT_ERRORS], ids=["offsets", "errors"])
def test_an_estimate_after_few_steps_is_as_kept(terms, arm, monkeypatch, data_regression):
    """Before it has settled, it shows by which way it goes."""
    observations, model, found = measured(arm, "poses"), ErrorModel(arm, terms), {}
    noisy = Disturbances(Noise(2e-4, 3e-4))
    reached = arm.forward(observations.joints + 0.01)
    (its,) = noisy.measure([np.random.default_rng(3)], reached[None])
    seen = replace(observations, measured=its)
    for steps in (1, 2, 4, 5, 60):
        monkeypatch.setattr(estimation, "STEPS", steps)
        estimate = identify(model, seen)
        again = identify(model, seen, start=estimate)
        found[str(steps)] = [
            [
                its.converged,
                coarse(its.noise),
                coarse(its.parameters, 3),
                round(its.log_evidence, 1),
            ]
            for its in (estimate, again)
        ]
    data_regression.check(plain(found))


def test_frames_of_more_rows_than_are_needed_are_as_kept(load, data_regression):
    arm = load(SMALL)
    real = Real(arm, 8, targets=3)
    joints, targets = real.postures(260), np.repeat([0, 1, 2], [200, 58, 2])
    seen = Observations(joints, real.poses(joints, targets), targets)
    data_regression.check(plain([of_frames(initial_frames(arm, seen)), fewest(seen)]))


def test_what_many_outliers_leave_is_as_kept(arm, data_regression):
    observations, rng = measured(arm, "poses", 40), np.random.default_rng(7)
    observations.measured[::3, :3, 3] += rng.normal(scale=0.05, size=(14, 3))
    model = ErrorModel(arm, OFFSETS, initial_frames(arm, observations))
    estimates = identify(model, observations), identify_by_consensus(model, observations)
    found = [[coarse(its.noise), its.weights > 0.3] for its in estimates]
    data_regression.check(plain([found, _by_chance(model)]))


def test_a_calibration_with_joint_errors_and_a_pattern_is_as_kept(controller, data_regression):
    robot, rng = controller.robot, np.random.default_rng(1)
    angles = controller.inverse(robot.workspace.to_poses(robot.workspace.sample(rng, 40)))
    damages = [EccentricGear("elbow_joint", 0.02, 0.3), Sag("shoulder_lift_joint", 1e-4)]
    damages += [EccentricGear("wrist_1_joint", 0.015)]
    noisy = Disturbances(Noise(1e-4, 2e-4))
    seen = noisy.measure([rng], apply(robot, damages).forward(angles)[None])[0]
    observations, found = Observations(angles, seen), {}
    few = observations[:24]
    commands = robot.workspace.sample(rng, 1, 4)
    poses, start = robot.workspace.to_poses(commands), controller.targets(commands).angles
    for name, terms in {"geometry": (OFFSETS,), "errors": (OFFSETS, JOINT_ERRORS)}.items():
        its = calibrate(robot.arm, terms, few)
        more = calibrate(robot.arm, terms, observations, last=its)
        found[name] = {
            "first": of_calibration(its, few),
            "more": coarse(more.forward(angles), 3),
            "angles": np.round(angles_for([its], poses, start), 4),
        }
        if its.pattern:
            found[name]["gain"] = round(float(its.pattern.gain), 0)
    found["geometry"]["first"].pop("said")
    data_regression.check(plain(found))


@pytest.mark.parametrize(
    ("kind", "size", "positions", "on_a_path"),
    [
        ("", 0.0, True, True),
        (LAG, 0.05, False, True),
        (DRIFT, 0.002, True, False),
        (JUMP, 0.001, False, False),
        (JUMP, 0.002, True, True),
    ],
)
def test_faults_that_are_named_are_as_kept(kind, size, positions, on_a_path, arm, data_regression):
    rows = 60
    times = np.cumsum(np.random.default_rng(5).uniform(0.1, 3, rows)) if positions else None
    session = Session(arm, 6, kind, size, positions, on_a_path, rows, times)
    named = [replace(its, size=float(coarse(its.size, 3))) for its in session.named()]
    data_regression.check(plain(named))


@pytest.mark.parametrize("gears", [0.0, 0.006])
def test_what_calibrations_are_worth_is_as_kept(gears, load, data_regression):
    arm = load(SMALL)
    real = Real(arm, 2, gears=gears)
    joints = real.postures(32)
    joints[:, 3] = joints[0, 3]
    seen = Observations(joints, real.poses(joints)[:, :3, 3])
    seen.measured[4] += 0.03
    told = []
    found = validate(arm, seen, initial_frames(arm, seen), told.append)
    data_regression.check(
        plain(
            {
                "told": told,
                "chosen": [found.chosen, found.unsettled, found.calibration.model.names[:4]],
                "counted": found.counted,
                "errors": {
                    f"{way}, {kind}": [
                        coarse(found.errors(way, kind), 2),
                        coarse(found.mean_error(way, kind), 2),
                    ]
                    for way in WAYS
                    for kind in KINDS
                },
                "radius": coarse(found.radius, 2),
                "coverage": [found.coverage(way) for way in WAYS],
                "still": found.postures.still,
            }
        )
    )


def test_why_rows_are_refused_is_as_kept(arm, load, data_regression):
    good, railed = measured(arm, "poses"), load(RAILED)
    bent = good.joints.copy()
    bent[7, 2] = 14.0
    line = Observations(good.joints, np.outer(np.arange(30.0), [0.1, 0.2, 0.3]))
    noise = Observations(good.joints, np.random.default_rng(1).normal(size=(30, 3)))
    model, rail = ErrorModel(arm, OFFSETS), ErrorModel(railed, OFFSETS)
    slid = np.full((12, 7), 0.4)
    slid[3, 0] = 11.0
    estimate = identify(model, Observations(good.joints, arm.forward(good.joints)))
    moving = Calibration(model, replace(estimate, converged=False))
    noisy = Calibration(model, replace(estimate, noise=np.array([0.02, 0.1])))
    cases = {
        "none": lambda: identify(model, good[:0]),
        "bent": lambda: identify(model, replace(good, joints=bent)),
        "slid": lambda: identify(rail, Observations(slid, np.zeros((12, 3)))),
        "joints": lambda: identify(model, replace(good, joints=good.joints[:, :5])),
        "measured": lambda: identify(model, replace(good, measured=good.measured[:, :2])),
        "far": lambda: identify(model, replace(good, measured=60 * good.measured)),
        "target": lambda: identify(model, replace(good, targets=np.arange(30) // 20)),
        "few": lambda: initial_frames(arm, good[:2]),
        "line": lambda: initial_frames(arm, line),
        "nothing": lambda: initial_frames(arm, noise),
        "postures": lambda: check_postures(find_postures(good.joints[:9], arm.slides, 0.0)),
        "moving": lambda: check_estimate(moving, good),
        "noisy": lambda: check_estimate(noisy, good),
    }
    said = {}
    for name, case in cases.items():
        with pytest.raises(RecalibError) as refused:
            case()
        said[name] = str(refused.value)
    data_regression.check(said)


def test_random_numbers_are_as_kept(data_regression):
    keys = (1,), (1, "links"), (1, "links", 2), (2, 2, "links")
    data_regression.check(plain([generator(*its).normal(size=3) for its in keys]))


def test_a_zero_at_the_end_of_few_keys_is_no_other_purpose():
    firsts = [generator(1, *keys).normal() for keys in (("a", 2), ("a", 2, 0), ("a", 0, 2))]
    assert firsts[0] == firsts[1] != firsts[2]
