"""Pictures of a board: the board, the lens, and the detection of corners."""
