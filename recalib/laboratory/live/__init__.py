"""An arm that moves, measures and calibrates itself."""
