"""Pictures of a board: the board itself, the lens, and where corners are in pictures."""
