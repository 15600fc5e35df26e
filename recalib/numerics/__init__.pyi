from .randomness import generator as generator
from .regression import LENGTHS as LENGTHS
from .regression import NOISE as NOISE
from .regression import VARIANCES as VARIANCES
from .regression import Process as Process
from .regression import is_time_to_search as is_time_to_search
