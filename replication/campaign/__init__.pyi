"""The public names and their modules."""

from .measuring import Replicate as Replicate
from .measuring import narrower as narrower
from .measuring import rows_of as rows_of
from .own import tune as tune
from .setups import Setup as Setup
from .variants import DOUBLE as DOUBLE
from .variants import TWO_MAPS as TWO_MAPS
from .variants import Variant as Variant
from .variants import lengths as lengths
