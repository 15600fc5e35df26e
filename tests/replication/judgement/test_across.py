"""A claim over all setups: mean, heterogeneity and luck, counts, and what they depend on."""

import numpy as np
import pandas as pd
import pytest

from replication.judgement.claims.across import Across
from replication.judgement.effects import effects
from replication.judgement.verdicts import CORRELATION, Comparison
from tests.synthetic import few_resamples

SETUPS = 64
RATIO = Across("theta", "a ratio")
ORDER = Across("order", "a correlation", CORRELATION, logarithmic=False)


def design(random) -> pd.DataFrame:
    half = np.arange(SETUPS) % 2
    columns = {"effort": half, "robot": np.arange(SETUPS) % 4, "home": random.permutation(half)}
    return pd.DataFrame(columns | {"norm": random.permutation(half)}).astype(str)


def outcomes(column, mean, luck=0.1, own=0.1, logarithmic=True, seed=0) -> pd.DataFrame:
    random = np.random.default_rng(seed)
    values = mean + own * random.normal(size=(SETUPS, 1)) + luck * random.normal(size=(SETUPS, 2))
    keys = pd.MultiIndex.from_product([range(SETUPS), range(2)], names=["universe", "replicate"])
    numbers = np.exp(values) if logarithmic else values
    return pd.DataFrame({column: numbers.ravel()}, index=keys).reset_index()


LEVELS = design(np.random.default_rng(1))


def test_ratios_are_averaged_as_logarithms_and_correlations_as_they_are():
    table = outcomes("theta", -0.3)
    over = RATIO.over(table, LEVELS)
    geometric = np.exp(np.log(table["theta"]).mean())
    assert over.mean.mean == pytest.approx(geometric)
    assert over.mean.low < geometric < over.mean.high
    table = outcomes("order", 0.3, logarithmic=False)
    assert ORDER.over(table, LEVELS).mean.mean == pytest.approx(table["order"].mean())
    reference = pd.DataFrame({"theta": [0.5, 2.0, 1.0], "order": [0.1, 0.2, 0.3]})
    assert RATIO.in_reference(reference).mean == pytest.approx(1)
    assert ORDER.in_reference(reference).mean == pytest.approx(0.2)


def test_setups_and_replicates_may_come_in_any_order():
    table = outcomes("theta", -0.3)
    shuffled = table.sample(frac=1, random_state=0)
    one, other = RATIO.over(table, LEVELS), RATIO.over(shuffled, LEVELS)
    assert one.mean == other.mean and one.model.luck == other.model.luck


def test_a_setup_with_a_bound_in_place_of_a_number_enters_no_mean():
    table = outcomes("factor", 4.0).assign(bound=0)
    table.loc[table["universe"] < 10, "factor"] = 1e6
    table.loc[(table["universe"] < 10) & (table["replicate"] == 1), "bound"] = [1, -1] * 5
    factor = Across("factor", "a factor", Comparison(50.0, below=False), table="horizon")
    over = factor.over(table, LEVELS)
    assert len(over.model.numbers) == len(over.levels) == SETUPS - 10
    assert over.mean.mean == pytest.approx(np.exp(4), rel=0.1)
    few = table["universe"] < SETUPS - 2
    assert factor.over(table.assign(bound=few.astype(int)), LEVELS) is None, "two have no mean"


@pytest.mark.parametrize(("mean", "counted"), [(-1.0, True), (1.0, True), (-0.1, False)])
def test_setups_are_counted_only_where_luck_is_small_beside_the_mean(mean, counted):
    over = RATIO.over(outcomes("theta", mean, own=0.8 if counted else 0.1), LEVELS)
    if not counted:
        assert over.holds is None
        return
    holds, alone = over.holds
    assert holds == (over.model.numbers < 0).sum()
    assert 0 < holds < SETUPS, "heterogeneity lets it hold and fail somewhere"
    expected = SETUPS if mean < 0 else 0  # no luck of a setup's number reaches the limit
    assert alone == pytest.approx(expected, abs=0.1)


def test_a_count_goes_by_the_side_and_the_limit_of_the_claim():
    above = Across("theta", "a share", Comparison(0.25, below=False))
    over = above.over(outcomes("theta", np.log(0.25) + 1.0, own=0.8), LEVELS)
    holds, alone = over.holds
    assert holds == (np.exp(over.model.numbers) > 0.25).sum() < SETUPS
    assert alone == pytest.approx(SETUPS, abs=0.1)


def test_where_there_is_no_luck_it_holds_by_the_mean_everywhere():
    over = RATIO.over(outcomes("theta", -0.5, luck=0.0, own=0.4), LEVELS)
    assert over.holds[1] == SETUPS


@few_resamples()
def test_what_is_said_is_in_the_unit_of_the_number():
    said = RATIO.over(outcomes("theta", -1.0), LEVELS).said(np.random.default_rng(2))
    assert (said["status"], said["setups"]) == ("measured", SETUPS)
    assert said["mean"] == pytest.approx(np.exp(-1), rel=0.05)
    assert said["mean_interval"][0] < said["mean"] < said["mean_interval"][1]
    assert said["heterogeneity"] == pytest.approx(0.1, abs=0.05), "of logarithms"
    assert said["luck"] == pytest.approx(0.1, abs=0.03)
    assert np.log(said["another_setup"]) == pytest.approx([-1.2, -0.8], abs=0.1)
    assert said["holds"] == SETUPS == pytest.approx(said["holds_by_luck_alone"], abs=0.01)
    assert said["depends_on"]["factor"] in LEVELS and said["depends_on"]["effect"] >= 1
    low, high = said["depends_on"]["interval"]
    assert low <= high


@few_resamples()
def test_what_a_choice_does_to_a_correlation_is_a_difference():
    table = outcomes("order", 0.3, logarithmic=False, own=0.0, luck=0.01)
    table["order"] += 0.2 * (LEVELS["home"].to_numpy()[table["universe"]] == "1")
    said = ORDER.over(table, LEVELS).said(np.random.default_rng(2))["depends_on"]
    assert (said["factor"], said["from"], said["to"]) == ("home", "0", "1")
    assert said["effect"] == pytest.approx(0.2, abs=0.02)


def test_in_95_percent_no_factor_without_effect_exceeds_chance():
    found = []
    with few_resamples():
        for repetition in range(40):
            random = np.random.default_rng(repetition)
            table = effects(random.normal(size=SETUPS), design(random), random)
            found.append((table["effect"] > table["chance"]).any())
    assert np.mean(found) <= 0.125, "five of forty: the binomial's 97 %"
