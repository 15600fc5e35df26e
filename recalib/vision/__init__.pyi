"""The public names and their modules."""

from .boards import Board as Board
from .boards import printable as printable
from .boards import read_board as read_board
from .detection import find_corners as find_corners
from .lenses import Lens as Lens
from .lenses import read_lens as read_lens
from .printing import draw_board as draw_board
