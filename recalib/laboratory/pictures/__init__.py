"""Pictures of a board as measurements of an arm."""
