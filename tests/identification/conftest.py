"""The arms that most tests of identification are about."""

import pytest

from recalib import load_arm
from tests.identification.real import ARMS


@pytest.fixture(scope="session")
def ur10():
    return load_arm(*ARMS["UR10"])


@pytest.fixture(scope="session")
def panda():
    return load_arm(*ARMS["Panda"])
