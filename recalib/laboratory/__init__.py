"""Calibration of a real arm: tables and a URDF in, a calibration and its files out."""
