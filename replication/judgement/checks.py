"""The check of final errors: every training against the band in which they are expected."""

from pathlib import Path

import pandas as pd

from recalib.errors import RecalibError
from replication.training.measured import ERRORS

KEYS = ["scenario", "learner"]

# The band is the mean plus and minus so many standard errors of it, at the settings that the
# searches found: other seeds would stay inside, and a change of a rule that matters does not.
STANDARD_ERRORS = 4
# Below these, an error is rounding and the nominal controller's tolerance.
NEGLIGIBLE = {"position_error_cm": 1e-3, "orientation_error_deg": 1e-3}


def report(summary: Path, expected: Path) -> str:
    """What the check says of a summary. Raises RecalibError with what is outside of its band."""
    table = check(pd.read_csv(summary), pd.read_csv(expected))
    text = table.to_string(index=False, float_format="{:.4g}".format)
    print(text)
    rows = [
        f"{row.scenario} {row.learner}: {row.error} is {row.value:.4g},"
        f" expected {row.low:.4g} to {row.high:.4g}"
        for row in table[~table["ok"]].itertuples()
    ]
    if rows:
        outside = f"{len(rows)} of the final errors are outside of their bands"
        raise RecalibError("\n".join([outside, *rows]))
    return text + "\n"


def propose(summary: Path) -> pd.DataFrame:
    """Bands for the final errors of a summary in a file."""
    return expect(pd.read_csv(summary))


def expect(summary: pd.DataFrame) -> pd.DataFrame:
    """Bands for the final errors of a summary, low to high: a row for each training and error."""
    rows = []
    for cells in summary.to_dict("records"):
        for error in ERRORS:
            mean = cells[f"final_{error}"]
            spread = STANDARD_ERRORS * cells[f"final_{error}_se"]
            band = (
                (0.0, NEGLIGIBLE[error])
                if mean < NEGLIGIBLE[error]
                else (mean - spread, mean + spread)
            )
            rows.append(
                {key: cells[key] for key in KEYS}
                | {"error": error, "low": band[0], "high": band[1]}
            )
    return pd.DataFrame(rows)


def check(summary: pd.DataFrame, expected: pd.DataFrame) -> pd.DataFrame:
    """Every final error beside its band, and whether it is `ok`: not if either is missing."""
    final = summary.melt(KEYS, [f"final_{error}" for error in ERRORS], "error", "value")
    final["error"] = final["error"].str.removeprefix("final_")
    table = expected.merge(final, "outer", [*KEYS, "error"])
    table["ok"] = (table["low"] <= table["value"]) & (table["value"] <= table["high"])
    return table
