"""What the colours of a recording mean: each one thing, distinct for the colour-blind, too."""

Colour = tuple[int, int, int]

WHITE, GREY = (255, 255, 255), (120, 125, 130)  # desired poses and texts; surroundings
NOMINAL = (86, 180, 233)  # the arm that the controller assumes, and what the map adds to commands
DAMAGE = (240, 228, 66)  # where the arm is not what its controller assumes
REACHED = (235, 70, 0)  # where it goes instead of where it is sent
BACKGROUND = 24, 28, 36
