"""An arm that stands in a laboratory: tables and a URDF in, a calibration and its files out."""
