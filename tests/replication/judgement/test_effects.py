import numpy as np
import pandas as pd

from replication.judgement import strongest

SETUPS = 30


def levels(random) -> pd.DataFrame:
    factors = {name: np.arange(SETUPS) % count for name, count in (("a", 2), ("b", 3), ("c", 5))}
    return pd.DataFrame({name: random.permutation(its) for name, its in factors.items()})


def test_the_factor_that_moves_a_number_is_named():
    random = np.random.default_rng(1)
    design = levels(random)
    numbers = 0.1 * random.normal(size=SETUPS) + 0.2 * (design["b"] == 2)
    assert strongest(numbers.to_numpy(), design) == "b"


def test_in_95_percent_no_factor_without_effect_is_named():
    named = 0
    for repetition in range(200):
        random = np.random.default_rng(repetition)
        named += strongest(random.normal(size=SETUPS), levels(random)) is not None
    assert named <= 19, "of 200: the binomial's 99 %"


def test_of_few_setups_nothing_is_named():
    """While a campaign is being measured, a level may have one setup, or none."""
    design = pd.DataFrame({"a": ["x", "y", "z"], "b": ["x", "x", "x"]})
    assert strongest(np.array([0.0, 5.0, 9.0]), design) is None
