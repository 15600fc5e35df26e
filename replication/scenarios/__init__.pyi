"""The public names and their modules."""

from .assignments import Ways as Ways
from .assignments import assign as assign
from .assignments import compare as compare
from .plants import Nominal as Nominal
from .plants import Resolved as Resolved
from .plants import nominal_controller as nominal_controller
from .plants import nominal_robot as nominal_robot
from .resolving import resolve as resolve
