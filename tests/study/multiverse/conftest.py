import pytest

from recalib.study.configuration.shipped import DESIGN
from recalib.study.multiverse.design import Designed, read_design
from tests.conftest import ROOT


@pytest.fixture(scope="session")
def design() -> list[Designed]:
    """The universes as designed and shipped."""
    return read_design(ROOT / DESIGN)
