"""The public names and their modules."""

from .geometric import angles_for as angles_for
from .kernels import JACOBIAN as JACOBIAN
from .kernels import THETA as THETA
from .kernels import WAITING as WAITING
from .kinds import KINDS as KINDS
from .kinds import class_of as class_of
from .kinds import kind_of as kind_of
from .learned import VERSION as VERSION
from .learned import read as read
from .maps import Maps as Maps
from .nets import regular_grid as regular_grid
from .observer import is_due as is_due
