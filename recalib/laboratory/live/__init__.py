"""Calibration of an arm that moves and measures by itself."""
