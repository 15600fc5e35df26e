"""Numbers of iterations that the campaign is about, for those who measure and for those who read."""

LONG = 10_000  # what the paper names: as long a training is watched on its way
MAPS = 200, 1000, 2000, 5000  # after which two maps are compared with one
