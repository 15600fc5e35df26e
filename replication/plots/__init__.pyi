"""The public names and their modules."""

from .factor import STEPS as STEPS
from .figures import APART as APART
from .figures import Figure as Figure
from .figures import figures_of as figures_of
from .forest import LABELS as LABELS
from .forest import rows as rows
from .palette import BOTH as BOTH
from .palette import FAILS as FAILS
from .palette import HOLDS as HOLDS
from .palette import SHORTER as SHORTER
from .palette import STYLES as STYLES
from .palette import UNKNOWN as UNKNOWN
from .palette import styles_of as styles_of
from .palette import styles_of_trainings as styles_of_trainings
from .rendering import drawn as drawn
from .style import STYLE as STYLE
