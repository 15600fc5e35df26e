"""The public names and their modules."""

from .consistency import check as check
from .geometry import check_robots as check_robots
