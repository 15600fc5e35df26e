"""The public names and their modules."""

from .alone import MARK as MARK
from .alone import NOTES as NOTES
from .alone import check_known as check_known
from .alone import check_writable as check_writable
from .alone import hold as hold
from .consistency import check as check
from .geometry import check_robots as check_robots
from .layers import LAYERS as LAYERS
from .result_files import write as write
from .studies import BANDS as BANDS
from .studies import LOCK as LOCK
from .studies import ship as ship
from .studies import study_of as study_of
