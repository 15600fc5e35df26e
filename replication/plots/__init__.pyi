"""The public names and their modules."""

from .contrasts import LABELS as LABELS
from .contrasts import rows as rows
from .drawing import drawn as drawn
from .figures import APART as APART
from .figures import Figure as Figure
from .figures import figures_of as figures_of
from .palette import BOTH as BOTH
from .palette import FAILS as FAILS
from .palette import HOLDS as HOLDS
from .palette import SHORTER as SHORTER
from .palette import STYLES as STYLES
from .palette import UNKNOWN as UNKNOWN
from .palette import styles_of as styles_of
from .palette import styles_of_trainings as styles_of_trainings
from .steps import STEPS as STEPS
from .style import STYLE as STYLE
