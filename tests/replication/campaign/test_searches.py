"""Short searches of each kind, as they ended: what changes these rows changes the campaign's.

It needs a deviation. Then keep them anew: `found.to_csv(KEPT, index=False)` in the test.
"""

from pathlib import Path

import pandas as pd

from replication.campaign import DOUBLE, TWO_MAPS
from replication.campaign.measuring import measure_variant
from replication.config import DESIGN, IMPROVED
from tests.conftest import ROOT, changed

KEPT = Path(__file__).with_name("searched.csv")
SEARCHED = IMPROVED, DOUBLE, TWO_MAPS, "two_maps_for_position_paper", "improved_rough"
SEARCH = {"trials": 32, "near_trials": 16, "runs": 3, "long_runs": 2, "fresh": 4}
CAMPAIGN = {"runs": 3, "late": 90, "rungs": (120, 140)}


def test_short_searches_find_what_they_found(study, tmp_path):
    rough = study.campaign.rough.model_copy(update={"trials": 4})
    short = changed(
        study,
        experiments={"iterations": 60},
        search=SEARCH | {"near": 90, "long": 60},
        campaign=CAMPAIGN | {"rough": rough},
    )
    tables = []
    for name in SEARCHED:
        others = [*tmp_path.iterdir()]
        tables.append(measure_variant(short, ROOT / DESIGN, 2, 1, name, others))
        tables[-1].to_csv(tmp_path / f"{name}.csv", index=False)
    found = pd.concat(tables, ignore_index=True).drop(columns="seconds")
    pd.testing.assert_frame_equal(found, pd.read_csv(KEPT), rtol=1e-3)
