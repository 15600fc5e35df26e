"""Everything that can be wrong with an arm, for whoever reads or writes descriptions."""

from recalib.damaged.damage import BaseShift, EncoderShift, LinkShortening
from recalib.damaged.disturbances import Noise, Outliers, Repeatability
from recalib.damaged.nongeometric import Backlash, EccentricGear, Sag

DAMAGES = LinkShortening, EncoderShift, BaseShift, EccentricGear, Sag, Backlash
DISTURBANCES = Noise, Repeatability, Outliers
