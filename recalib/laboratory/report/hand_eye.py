"""Hand-eye calibration by name: where camera and board are, how sure that is, what it is worth."""

from collections.abc import Iterator, Sequence

import numpy as np
from scipy.spatial.transform import Rotation

from recalib.identification.validation import NOTHING, WAYS
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
    as_right = result.places_by(result.validation.full[NOTHING], [], result.arm.tool)
    chosen = result.validation.chosen
    lines = [*_tables(result.places, ""), *_errors(result, chosen, "held_out")]
    lines += ["# the same with the arm taken as right: what its errors cost"]
    lines += _tables(as_right, "arm_as_right.")
    lines += _errors(result, NOTHING, "arm_as_right.held_out")
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


def _errors(result: Calibrated, kind: str, name: str) -> Iterator[str]:
    yield f"[{name}]"
    for way in WAYS:
        millimetres = 1e3 * result.validation.mean_error(way, kind)
        pixels = pixel_error(result, way, kind)
        yield f'"{way}" = {{ millimetres = {millimetres:.4g}, pixels = {pixels:.4g} }}'
    yield ""


def _deviation(deviations: tuple[float, float]) -> str:
    length, turn = deviations
    return f'["{1e3 * length:.3g} mm", "{np.degrees(turn):.3g} deg"]'


def _quantities(numbers: np.ndarray, unit: str) -> str:
    return "[" + ", ".join(f'"{number:.5f} {unit}"' for number in numbers) + "]"
