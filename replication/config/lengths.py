"""Numbers of iterations of the campaign, for code that measures it and code that reads it."""

LONG = 10_000  # what the paper names: as long a training is watched on its way
MAPS = 200, 1000, 2000, 5000  # after which two maps are compared with one
