"""What simulated arms have to show: programs that print tables or draw films, and no tests."""

from tests import station  # noqa: F401, for the modules of the examples' rehearsal
