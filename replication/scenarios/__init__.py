"""A damage on a robot: which links and encoders, and the plant that it makes."""
