from .error_model import NO_ERRORS as NO_ERRORS
from .error_model import ErrorModel as ErrorModel
from .error_model import held as held
from .frames import HELD as HELD
from .frames import Frames as Frames
from .frames import nearest_rotation as nearest_rotation
from .linearisation import displacements as displacements
from .optics import Optics as Optics
