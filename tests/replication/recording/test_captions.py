"""What a recording says of itself."""

import json

import numpy as np
import pytest

from recalib.damaged.disturbances import Noise
from replication.recording import captions
from replication.training.recordings import Recording


def test_it_keeps_its_job_its_damage_and_what_made_it(job, columns):
    def said(key):
        return columns("/__properties/run", key)[1][0][0]

    assert Recording.model_validate_json(said("job")) == job
    assert said("robot") == "ur10" and said("numpy") == np.__version__
    assert json.loads(said("damage"))[1] == "forearm: 4 cm short"


@pytest.mark.parametrize("damages", [(), (Noise(0.0002, 0.0003),)], ids=["intact", "noise alone"])
def test_of_an_undamaged_arm_it_speaks_of_no_damage_and_no_misses(resolved, recording, damages):
    its, learned = resolved(damages), recording[1]["improved"]
    panel = captions.about(its, {"improved": learned})
    assert "Nothing is wrong" in panel and "damage" not in panel and "miss" not in panel
    assert "although there is nothing to correct" in panel and ("noise" in panel) == bool(damages)
    first, *_, last = captions.progress(its, learned)
    assert first.startswith("before learning: ") and last.startswith("after learning: ")
