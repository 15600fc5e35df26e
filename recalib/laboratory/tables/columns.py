"""The columns of tables (CSV): the content of each, and which belong together.

Reading, checking and `recalib calibrate --help` use these definitions. To add a column, add it to
`MEASURED`; its values are in `Measurements.columns` under its name.
"""

from dataclasses import dataclass

from recalib.files.quantities import ANGLE, LENGTH, NUMBER, TIME, Quantity

NAME = Quantity("a name", {})  # never empty, and always in the same capitals
TEXT = Quantity("a text", {})


@dataclass(frozen=True)
class Columns:
    """Columns that are given together, or not at all."""

    name: str  # of the array with their values
    headings: tuple[str, ...]
    quantity: Quantity  # of their cells
    meaning: str = ""  # for messages and help
    unit: str = ""  # in tables that we write
    needed: bool = False  # whether a table must have these columns

    @property
    def written(self) -> list[str]:
        """The headings as we write them: `x [mm]`."""
        return [f"{heading} [{self.unit}]" if self.unit else heading for heading in self.headings]


POSITIONS = Columns(
    "positions", ("x", "y", "z"), LENGTH, "position of the target in the instrument's frame", "mm"
)
QUATERNIONS = Columns(
    "quaternions", ("qx", "qy", "qz", "qw"), NUMBER, "its rotation, if measured: as a quaternion,"
)
ROTATION_VECTORS = Columns(
    "rotation_vectors", ("rx", "ry", "rz"), ANGLE, "or as a rotation vector,", "deg"
)
ROLL_PITCH_YAW = Columns(
    "roll_pitch_yaw",
    ("roll", "pitch", "yaw"),
    ANGLE,
    "or as rotations about the fixed axes x, y and z, as in URDF",
    "deg",
)
ROTATIONS = QUATERNIONS, ROTATION_VECTORS, ROLL_PITCH_YAW
TARGETS = Columns("targets", ("target",), NAME, "name of the target, if the tool has several")
SOCKETS = Columns(
    "sockets", ("socket",), NAME, "instead of a position: name of the socket that held the ball"
)
PICTURE = "picture"
PICTURES = Columns("pictures", (PICTURE,), TEXT, "file name of a picture, for recalib observe")
TIMES = Columns(
    "times",
    ("time",),
    TIME,
    "when the row was measured; without a unit, a date such as 2026-11-23T08:15:00.5",
    "s",
)
NOMINAL = Columns(
    "nominal",
    ("x_nominal", "y_nominal", "z_nominal"),
    LENGTH,
    "position according to the controller, which is compared with the URDF before the fit",
    "mm",
)
ERRORS = Columns(
    "errors",
    ("x_error", "y_error", "z_error"),
    LENGTH,
    "measured minus nominal position, instead of x, y, z",
    "mm",
)
FAKE_POSITIONS = Columns(
    "fake_positions",
    ("x_fake", "y_fake", "z_fake"),
    LENGTH,
    "commands of recalib correct, ignored",
    "mm",
)
FAKE_ROTATIONS = Columns(
    "fake_rotations", ("rx_fake", "ry_fake", "rz_fake"), ANGLE, "as above", "deg"
)

MEASURED = (
    *(POSITIONS, *ROTATIONS, TARGETS, SOCKETS, PICTURES, TIMES, NOMINAL, ERRORS),
    *(FAKE_POSITIONS, FAKE_ROTATIONS),
)
DESIRED = (POSITIONS, *ROTATIONS, TARGETS, PICTURES)
