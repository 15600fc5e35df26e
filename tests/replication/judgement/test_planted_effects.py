"""Worlds whose truth is known: what is equal is called so, and what differs is found."""

import numpy as np
import pandas as pd
import pytest
from scipy.stats import binom

from replication.config.shipped import DESIGN, REFERENCE
from replication.judgement import effects, intervals
from replication.judgement.hierarchy import ASSUMED_LUCK
from replication.judgement.intervals import LEVEL
from tests.conftest import ROOT
from tests.synthetic import REPLICATES, Synthetic

COLUMNS = ["maps_ritter_late", "maps_ritter", "maps_improved"]  # three worlds a judgement
CLAIM, REPETITIONS = "separate-maps", 40


@pytest.fixture
def verdicts(study, tmp_path, monkeypatch):
    """A function that plants ratios in campaigns of the committed size, and judges them.

    Each with luck of its own, as large as was assumed for the power of the campaign.
    """
    monkeypatch.setattr(intervals, "RESAMPLES", 200)
    monkeypatch.setattr(effects, "RESAMPLES", 2)
    monkeypatch.chdir(ROOT)  # where the design is
    synthetic = Synthetic(tmp_path, study)
    plain = synthetic.reference(), synthetic.outcomes(), synthetic.horizon()
    luck = pd.read_csv(DESIGN)["effort"].map(ASSUMED_LUCK).to_numpy()[:, None, None]

    def planted(table, ratio, spread, size, random):
        """A table with the ratio in each of the columns."""
        values = ratio * np.exp(spread * random.normal(size=(*size, len(COLUMNS))))
        return table.assign(**dict(zip(COLUMNS, values.reshape(-1, len(COLUMNS)).T, strict=True)))

    def verdicts(ratio: float, repetitions: int) -> np.ndarray:
        found = []
        for repetition in range(repetitions):
            random = np.random.default_rng([repetition, 20])
            reference = planted(plain[0], ratio, ASSUMED_LUCK["full"], (REPLICATES, 1), random)
            size = study.universes.count, study.universes.replicates
            outcomes = planted(plain[1], ratio, luck, size, random)
            synthetic.write(REFERENCE, reference)
            synthetic.campaign(outcomes=outcomes, horizon=plain[2])
            systems = synthetic.judged(CLAIM)["systems"]
            found += [its["verdict"] for its in systems.values()]
        return np.array(found)

    return verdicts


def shares(verdicts) -> dict[str, float]:
    return {str(each): float((verdicts == each).mean()) for each in np.unique(verdicts)}


@pytest.mark.slow
def test_what_is_equal_has_no_effect_in_most_worlds_and_is_almost_never_decided(verdicts):
    """The committed power study has a thousand worlds; here, chance is allowed for."""
    worlds = verdicts(1.0, REPETITIONS)
    found = shares(worlds)
    assert found.get("no effect", 0) >= 0.8
    decided = found.get("supported", 0) + found.get("contradicted", 0)
    assert decided * len(worlds) <= binom.ppf(0.99, len(worlds), 1 - LEVEL)


@pytest.mark.slow
@pytest.mark.parametrize(("ratio", "verdict"), [(0.9, "supported"), (1 / 0.9, "contradicted")])
def test_a_tenth_of_the_error_is_found_in_most_worlds_and_never_taken_for_the_opposite(
    verdicts, ratio, verdict
):
    found = shares(verdicts(ratio, REPETITIONS))
    assert found[verdict] >= 0.8
    assert {*found} <= {verdict, "no effect", "undecided"}


@pytest.mark.parametrize(
    ("ratio", "possible"),
    [
        (0.5, {"supported"}),
        (1.0, {"no effect", "undecided"}),  # one in ten worlds is not narrow enough
        (2.0, {"contradicted"}),
    ],
)
def test_what_is_large_or_nothing_is_seen_in_a_single_campaign(verdicts, ratio, possible):
    assert {*verdicts(ratio, 1)} == possible
