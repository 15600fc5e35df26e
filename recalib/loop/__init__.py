"""The trial loop, and what robots and learners have to offer for it."""
