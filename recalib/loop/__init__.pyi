from .moves import check_moves as check_moves
from .training import SUMMARIES as SUMMARIES
from .training import measure as measure
