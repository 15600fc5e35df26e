"""The public names and their modules."""

from .archives import flat as flat
from .archives import read_archive as read_archive
from .archives import write_archive as write_archive
from .bounded import Amount as Amount
from .outputs import write_new as write_new
from .quantities import ANGLE as ANGLE
from .quantities import COMPLIANCE as COMPLIANCE
from .quantities import LENGTH as LENGTH
from .storage import whole as whole
