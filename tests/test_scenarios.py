import numpy as np
import pytest

from recalib.errors import UnknownName
from recalib.study.experiments import campaign
from recalib.study.trainings import scenario_of


def test_a_scenario_may_name_its_robot(study):
    assert scenario_of(study, "links") == ("links", "ur10")
    assert scenario_of(study, "links_encoders-z1") == ("links_encoders", "z1")
    with pytest.raises(UnknownName, match="intact, links"):
        scenario_of(study, "link")
    with pytest.raises(UnknownName, match="ur10, ur3, ur5, z1"):
        scenario_of(study, "links-ur7")


def test_compared_learners_see_the_same_poses_and_never_the_tests():
    short, long = (
        campaign.desired_poses(1, "links", range(3), 20),
        campaign.desired_poses(1, "links", range(1, 3), 200),
    )
    assert np.array_equal(short[1:], long[:, :20])
    tests = campaign.test_poses(1, "links", range(3), 20)
    assert not np.isclose(tests, short).any()
    assert not np.isclose(short, campaign.desired_poses(1, "encoders", range(3), 20)).any()
    assert not np.isclose(short[0], short[1]).any()
