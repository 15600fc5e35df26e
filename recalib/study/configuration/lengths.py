"""Numbers of iterations that the campaign names, where those who read it find them, too."""

LONG = 10_000  # what the paper names: as long a training is watched on its way
MAPS = 200, 1000, 2000, 5000  # after which two maps are compared with one
