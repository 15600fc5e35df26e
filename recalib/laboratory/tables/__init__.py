"""Tables of measurements, and their descriptions: how they are read."""
