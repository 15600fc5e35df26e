"""Add measured replicates to the campaign's table.

`python -m replication.campaign.ship FOLDER` adds all replicates in a folder. They replace earlier
measurements of the same replicates.
"""

import sys
from pathlib import Path

import pandas as pd

from recalib.files.storage import whole
from replication.config.shipped import OUTCOMES

ROW = ["setup", "replicate", "variant", "iterations"]


def ship(folder: Path, table: Path = Path(OUTCOMES)) -> None:
    """Add the replicates in a folder, files SETUP/REPLICATE.csv, to a table."""
    new = pd.concat(map(pd.read_csv, sorted(folder.glob("*/*.csv"))), ignore_index=True)
    if table.exists():
        old = pd.read_csv(table)
        measured = pd.MultiIndex.from_frame(new[ROW[:2]])
        retained = old[~pd.MultiIndex.from_frame(old[ROW[:2]]).isin(measured)]
        new = pd.concat([retained, new], ignore_index=True)
    with whole(table) as path:
        new.sort_values(ROW, kind="stable").to_csv(path, index=False)


if __name__ == "__main__":
    ship(*map(Path, sys.argv[1:]))
