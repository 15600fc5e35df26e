"""A scenario in which everything counts, for tests that keep what comes out."""

from pathlib import Path

import pytest

from recalib.damaged.damage import EncoderShift, LinkShortening
from workflow.scripts.call import write


@pytest.fixture(scope="session")
def uneven_scenario(plan, tmp_path_factory) -> Path:
    """File of the study's robot with a link short, an encoder shifted, and noise of its own."""
    noise = plan.study.scenarios["noise"][-1]
    damages = LinkShortening("forearm_link", 0.04), EncoderShift("wrist_1_joint", -0.06), noise
    resolved = plan.resolved("intact").model_copy(update={"scenario": "uneven", "damages": damages})
    path = tmp_path_factory.mktemp("scenario") / "uneven.json"
    write(path, resolved)
    return path
