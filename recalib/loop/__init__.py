"""The trial loop, and the interfaces of robots and learners."""
