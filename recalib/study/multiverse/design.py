"""The design of the multiverse: which universes there are, and where their robots can work.

It is made before the first universe is run, and kept in a file that people can read.
"""

import csv
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import yaml

from recalib.study.configuration.damages import Entry, describe
from recalib.study.configuration.part import Frozen
from recalib.study.inference.measured import NONE

if TYPE_CHECKING:
    import pandas as pd

LISTS = "moved", "damage"  # columns of entries
LINE = 1000  # characters: no list is longer


class Designed(Frozen):
    """A universe as designed: a row of the file.

    Attributes:
        universe: its number.
        row: that of the quasi-random sequence; those between two universes were refused.
        seed: of its search, its poses and its trainings.
        levels: of each factor.
        home_deg: at the centre of the workspace, the joints in the order of the configuration.
        homes_refused: by the controller, before this one.
        moved: by which the whole robot is moved, and turned.
        damage: the paper's, as assigned to the robot.
        position_error_cm, orientation_error_deg: mean initial errors.
    """

    universe: int
    row: int
    seed: int
    levels: dict[str, str]
    home_deg: tuple[float, ...]
    homes_refused: int
    moved: tuple[Entry, ...]
    damage: tuple[Entry, ...]
    position_error_cm: float
    orientation_error_deg: float

    def as_row(self) -> dict[str, Any]:
        """Its columns in the file."""
        row = {name: getattr(self, name) for name in type(self).model_fields}
        row["home_deg"] = " ".join(f"{angle:g}" for angle in self.home_deg)
        row |= {name: _in_words(row[name]) for name in LISTS}
        levels = row.pop("levels")
        return {"universe": row.pop("universe"), "row": row.pop("row")} | levels | row

    @classmethod
    def from_row(cls, row: Mapping[str, str]) -> Self:
        """What a row of the file says. A file may have other factors than a new one would."""
        levels = {name: text for name, text in row.items() if name not in cls.model_fields}
        rest: dict[str, Any] = {name: text for name, text in row.items() if name not in levels}
        rest["home_deg"] = rest["home_deg"].split()
        rest |= {name: yaml.safe_load(rest[name]) for name in LISTS}
        return cls.model_validate(rest | {"levels": levels})


def _in_words(entries: Sequence[Entry]) -> str:
    """Entries as config.yaml has them, in a line."""
    said = [describe(entry) for entry in entries]
    return yaml.safe_dump(said, default_flow_style=True, sort_keys=False, width=LINE).strip()


def read_design(path: str | Path) -> list[Designed]:
    """The universes of a file."""
    with Path(path).open(encoding="utf-8", newline="") as file:
        return [Designed.from_row(row) for row in csv.DictReader(file)]


def put_together(chunks: list[Path], design: str = "") -> "pd.DataFrame":
    """The tables of the campaign in these files as one, with the digest of a design they follow."""
    import pandas as pd

    table = pd.concat(map(pd.read_csv, chunks), ignore_index=True)
    if "intact" in table:  # below, every machine finds another error
        table["intact"] = table["intact"].clip(lower=NONE)
    if design:
        table.insert(0, "design", design)
    return table
