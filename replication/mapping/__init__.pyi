"""The public names and their modules."""

from .propagation import ball as ball
from .propagation import grown as grown
from .propagation import propagation_errors as propagation_errors
from .quantisation import RATES as RATES
from .quantisation import WIDTHS as WIDTHS
from .quantisation import kohonen as kohonen
from .solutions import are_same as are_same
from .solutions import joint_solutions as joint_solutions
from .true_mapping import mapping_jacobians as mapping_jacobians
from .true_mapping import true_commands as true_commands
