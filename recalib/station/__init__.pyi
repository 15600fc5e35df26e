"""The public names and their modules."""

from .guarded import Guarded as Guarded
from .interface import cells_of as cells_of
from .opening import open_station as open_station
from .pictures import BoardInPictures as BoardInPictures
from .pictures import PicturesOfABoard as PicturesOfABoard
