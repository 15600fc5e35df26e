"""Hand-eye calibration by name: where camera and board are, how sure that is, what it is worth."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.arm_as_right import arm_as_right
from recalib.identification.held_out import HeldOut
from recalib.identification.validation import WAYS
from recalib.laboratory.arms.urdf import angles_of
from recalib.laboratory.calibrate import Calibrated
from recalib.laboratory.places import Place


def pixel_error(result: Calibrated, way: str, kind: str, sight: int | None = None) -> float:
    """px, the mean over held-out pictures of how far corners are off, each a root mean square.

    Args:
        sight: the number of a camera's sight of a board; all of them unless given.
    """
    optics, counted = result.observations.optics, result.counted
    assert optics is not None
    if sight is not None:
        counted = counted[result.observations.targets[counted] == sight]
    residuals = result.validation.held_out[way][kind].residuals
    return float(optics.moved(residuals)[counted].mean())


def static_transform(place: Place) -> str:
    """The command of ROS 2 that publishes a place."""
    turn = Rotation.from_matrix(place.pose[:3, :3]).as_quat()
    names = "x", "y", "z", "qx", "qy", "qz", "qw"
    numbers = zip(names, np.concatenate([place.pose[:3, 3], turn]), strict=True)
    given = " ".join(f"--{name} {number:.7f}" for name, number in numbers)
    child = place.name.removeprefix("the ").replace(" ", "_")
    frames = f"--frame-id {place.link} --child-frame-id {child}"
    return f"ros2 run tf2_ros static_transform_publisher {given} {frames}"


def hand_eye(result: Calibrated) -> str:
    """A TOML with all frames, held-out errors, and the same with the arm taken as right."""
    validation = result.validation
    held_out = {way: validation.held_out[way][validation.chosen] for way in WAYS}
    folds = {way: errors.folds for way, errors in held_out.items()}
    as_right, without = arm_as_right(result.geometry, result.observations, folds)
    places = result.places_by(as_right, [], result.arm.tool)
    lines = [*_tables(result.places, ""), *_errors(result, held_out, "held_out")]
    lines += ["# the same with the arm taken as right: what its errors cost"]
    lines += _tables(places, "arm_as_right.")
    lines += _errors(result, without, "arm_as_right.held_out")
    return "\n".join(lines)


def _tables(places: Sequence[Place], prefix: str) -> Iterator[str]:
    for place in places:
        yield f"[{prefix}{place.name.removeprefix('the ').replace(' ', '_')}]"
        yield f'in = "{place.link}"'
        yield f"position = {_quantities(1e3 * place.pose[:3, 3], 'mm')}"
        yield f"roll_pitch_yaw = {_quantities(np.degrees(angles_of(place.pose)), 'deg')}"
        if not prefix:  # errors of an arm that is taken as right are no noise
            yield f"deviation = {_deviation(place.deviations)}"
            yield f"deviation_beside_the_real_link = {_deviation(place.real_deviations)}"
        yield f'ros = "{static_transform(place)}"'
        yield ""


def _errors(result: Calibrated, held_out: Mapping[str, HeldOut], name: str) -> Iterator[str]:
    optics = result.observations.optics
    assert optics is not None
    yield f"[{name}]"
    for way, errors in held_out.items():
        judged = result.validation.judged(way)
        millimetres = 1e3 * errors[judged].errors[:, 0].mean()
        pixels = optics.moved(errors.residuals)[judged].mean()
        yield f'"{way}" = {{ millimetres = {millimetres:.4g}, pixels = {pixels:.4g} }}'
    yield ""


def _deviation(deviations: tuple[float, float]) -> str:
    length, turn = deviations
    return f'["{1e3 * length:.3g} mm", "{np.degrees(turn):.3g} deg"]'


def _quantities(numbers: np.ndarray, unit: str) -> str:
    return "[" + ", ".join(f'"{number:.5f} {unit}"' for number in numbers) + "]"
