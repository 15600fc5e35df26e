"""The public names and their modules."""

from .boards import Board as Board
from .boards import printable as printable
from .boards import read_board as read_board
from .detection import Corners as Corners
from .detection import Unusable as Unusable
from .detection import find_corners as find_corners
from .lens_search import find_lens as find_lens
from .lenses import Lens as Lens
from .lenses import read_lens as read_lens
from .printing import draw_board as draw_board
from .views import board_pose as board_pose
from .views import optics_of as optics_of
from .views import projected as projected
from .views import sighting as sighting
