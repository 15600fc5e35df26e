"""All kinds of damages and disturbances, for code that reads or writes descriptions."""

from recalib.damaged.damage import BaseShift, EncoderShift, LinkShortening
from recalib.damaged.disturbances import Noise, Outliers, Repeatability
from recalib.damaged.nongeometric import Backlash, EccentricGear, Sag

DAMAGES = LinkShortening, EncoderShift, BaseShift, EccentricGear, Sag, Backlash
DISTURBANCES = Noise, Repeatability, Outliers
