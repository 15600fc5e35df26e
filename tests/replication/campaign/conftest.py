import pytest

from replication.campaign.design import Designed, read_design
from replication.config.shipped import DESIGN
from tests.conftest import ROOT


@pytest.fixture(scope="session")
def design() -> list[Designed]:
    """The universes as designed and shipped."""
    return read_design(ROOT / DESIGN)
