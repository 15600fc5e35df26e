"""Arms that users bring: a URDF, a Denavit-Hartenberg table, that of Universal Robots."""
