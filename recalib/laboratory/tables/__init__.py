"""Tables of measurements: how they are read, and checked before the fit."""
