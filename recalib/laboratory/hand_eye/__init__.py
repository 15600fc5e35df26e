"""Hand-eye calibration from flange poses, without a URDF."""
