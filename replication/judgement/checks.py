"""The check of final errors: every training against its expected band."""

from pathlib import Path

import pandas as pd

from recalib.errors import RecalibError
from replication.training.measured import ERRORS

KEYS = ["robot", "scenario", "learner", "iterations"]
BAND = [*KEYS, "error", "low", "high"]  # the columns of a table of bands

# A band is twice as wide as the 95 % interval of the mean, on a logarithmic scale. Other seeds stay
# inside it; a relevant change of a rule does not.
REACH = 2
# Smaller errors come from rounding and from the nominal controller's tolerance.
NEGLIGIBLE = {"position_error_cm": 1e-3, "orientation_error_deg": 1e-3}


def report(summary: Path, expected: Path) -> str:
    """The report on a summary. Raises RecalibError with a list of errors outside their bands."""
    table = check(pd.read_csv(summary), pd.read_csv(expected))
    text: str = table.to_string(index=False, float_format="{:.4g}".format)
    rows = [
        f"{row.learner}, {row.iterations} iterations, on the {row.robot}, {row.scenario}:"
        f" {row.error} is {row.value:.4g}, expected {row.low:.4g} to {row.high:.4g}"
        for row in table[~table["ok"]].itertuples()
    ]
    if rows:
        outside = f"{len(rows)} of {len(table)} final errors are outside their bands"
        raise RecalibError("\n".join([outside, *rows]))
    print(f"all {len(table)} final errors are inside their bands")
    return text + "\n"


def propose(summary: Path) -> pd.DataFrame:
    """Bands for the final errors in a summary's file."""
    return expect(pd.read_csv(summary))


def expect(summary: pd.DataFrame) -> pd.DataFrame:
    """Bands for the final errors in a summary: a row for each training and error."""
    rows = []
    for cells in summary.to_dict("records"):
        for error in ERRORS:
            mean, *ends = (cells[f"final_{error}{end}"] for end in ("", "_low", "_high"))
            low, high = 0.0, NEGLIGIBLE[error]
            if mean >= high:
                low, high = (mean * (end / mean) ** REACH for end in ends)
            labels = {key: cells[key] for key in KEYS}
            rows.append(labels | {"error": error, "low": low, "high": high})
    return pd.DataFrame(rows, columns=BAND)


def check(summary: pd.DataFrame, expected: pd.DataFrame) -> pd.DataFrame:
    """Every final error with its band, and whether it is `ok`; if either is missing, it is not."""
    final = summary.melt(KEYS, [f"final_{error}" for error in ERRORS], "error", "value")
    final["error"] = final["error"].str.removeprefix("final_")
    table = expected.merge(final, "outer", [*KEYS, "error"])
    table["ok"] = (table["low"] <= table["value"]) & (table["value"] <= table["high"])
    return table
