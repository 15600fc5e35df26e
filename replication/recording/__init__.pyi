"""The public names and their modules."""

from .blueprint import sight_of as sight_of
from .film import take_film as take_film
from .in_browser import script as script
from .phases import BEFORE as BEFORE
from .phases import CLOCK as CLOCK
from .phases import FRAMES_A_SECOND as FRAMES_A_SECOND
from .phases import POSES as POSES
from .phases import VISIT as VISIT
from .phases import move as move
from .recorded import recorded_places as recorded_places
from .recorded import typical_seed as typical_seed
from .recordings import check_end as check_end
from .recordings import record as record
from .watched import visiting_order as visiting_order
