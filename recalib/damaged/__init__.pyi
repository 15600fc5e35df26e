from .damage import Damage as Damage
from .damage import end_of as end_of
from .imperfections import Imperfection as Imperfection
from .imperfections import Link as Link
