"""What the reference study's replicates say in more detail, where it was made up."""

from itertools import product

import numpy as np
import pandas as pd
import pytest
from scipy.stats import t

from replication.config.lengths import MAPS
from replication.training.measured import ERRORS
from replication.judgement.reference import (
    one_search,
    schedules,
    speed_of_two_maps,
    width_order,
)
from tests.synthetic import Synthetic


@pytest.fixture(scope="module")
def reference(few, tmp_path_factory):
    return Synthetic(tmp_path_factory.mktemp("reference"), few).reference()


def test_two_maps_are_as_many_times_as_fast_as_their_errors_say(reference):
    """Half of the error, which falls by the root of the iterations: in a quarter of them."""
    exact = {
        f"{maps}_{system}_{length}_{error}": level / length**0.5
        for maps, level in (("one", 20), ("two", 10))
        for system, length, error in product(("improved", "ritter"), MAPS, ERRORS)
    }
    for row in speed_of_two_maps(reference.assign(**exact)):
        assert row["factor"] == pytest.approx((0.25,) * 3)
        assert row["unknown"] == 0


def test_replicates_that_are_not_within_the_ladder_are_counted_and_left_out(reference):
    columns = [name for name in reference if name.startswith("two_")]
    never = reference.assign(**dict.fromkeys(columns, 1000000.0))
    for row in speed_of_two_maps(never):
        assert row["unknown"] == 8 and np.isnan(row["factor"]).all()


def test_schedules_are_told_apart_by_n_and_by_the_law_of_the_rate(reference):
    rows = schedules(reference.assign(schedule_ritter_linear_6=2.0))
    assert len({(row["system"], row["rate"], row["n"]) for row in rows}) == len(rows) == 8
    for row in rows:
        one = (row["system"], row["rate"], row["n"]) == ("Ritter's", "linear", 6)
        assert row["ratio"].mean == pytest.approx(2.0 if one else 0.5, rel=0.15)
        assert row["verdict"] == ("contradicted" if one else "supported")


def trials(slope: float, count: int = 200) -> pd.DataFrame:
    """Errors that rise with the paper's order turned around, by a slope; later rounds do not."""
    random = np.random.default_rng(0)
    widths = [f"{kind}/{net}" for kind in ("position", "orientation") for net in ("g_k", "g_kl")]
    table = pd.DataFrame(np.exp(random.normal(size=(count, 4))), columns=widths)
    order = np.log(table["position/g_k"] / table["position/g_kl"])
    other = np.log(table["orientation/g_kl"] / table["orientation/g_k"])
    table["position_error_cm"] = np.exp(slope * order + random.normal(size=count))
    table["orientation_error_deg"] = np.exp(slope * other + random.normal(size=count))
    table["search"] = np.arange(count) % 4
    later = table.assign(round=2, position_error_cm=1.0 / np.exp(order))
    return pd.concat([table.assign(round=1), later], ignore_index=True)


@pytest.mark.parametrize("slope", [1.0, -1.0])
def test_widths_that_matter_are_told_from_an_exchange_of_them(slope):
    for row in width_order(trials(slope), np.random.default_rng(1)):
        assert row["p"] < 0.001 and row["trials"] == 200


def test_widths_that_do_not_matter_are_not():
    rows = width_order(trials(0.0), np.random.default_rng(1))
    assert min(row["p"] for row in rows) > 0.01
    assert len({row["claim"] for row in rows}) == 2


def test_what_one_search_would_find_has_students_prediction_interval():
    values = np.random.default_rng(1).normal(size=5)
    found = one_search(pd.Series(np.exp(values)))
    half = t.ppf(0.975, 4) * values.std(ddof=1) * np.sqrt(1 + 1 / 5)
    assert np.log(found) == pytest.approx(values.mean() + half * np.array([0, -1, 1]))


def test_of_few_trials_p_is_the_share_of_all_exchanges():
    """One search whose errors rise with one order alone: two of 2^7 exchanges go as far."""
    table = pd.DataFrame({"position/g_k": np.exp([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7])})
    table["position/g_kl"], table["orientation/g_k"] = 1.0, table["position/g_k"]
    table["orientation/g_kl"] = 1 / table["position/g_kl"]
    ranks = np.array([-3.0, -2.0, -1.0, 0.5, 1.0, 2.0, 3.0])
    for column in ("position/g_k", "orientation/g_k"):
        table[column] = np.exp(np.sign(ranks) * np.arange(1, 8))
    table["position_error_cm"] = table["orientation_error_deg"] = ranks
    table = table.assign(search=0, round=1)
    for row in width_order(table, np.random.default_rng(1)):
        assert row["p"] == pytest.approx(2 / 2**7, rel=0.3)
