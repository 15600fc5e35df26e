"""The colours of a recording; each has one meaning, and they are distinct to the colour-blind."""

Colour = tuple[int, int, int]

WHITE, GREY = (255, 255, 255), (120, 125, 130)  # desired poses and texts; surroundings
NOMINAL = (86, 180, 233)  # the arm that the controller assumes, and what the map adds to commands
DAMAGE = (240, 228, 66)  # damaged parts of the arm
REACHED = (235, 70, 0)  # achieved poses
BACKGROUND = 24, 28, 36
