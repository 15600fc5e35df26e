"""The page with the errors of all packages, and what each reads, writes and checks."""

from collections.abc import Mapping
from pathlib import Path

import jinja2
import pandas as pd
import yaml

from tests.peers.tasks import POSES, SUBSETS

HERE = Path(__file__).parent
PAGE = HERE.parents[1] / "docs" / "peers.md"
OURS, FIGAROH = "recalib", "figaroh, "
UNKNOWN_FRAMES = "untold"  # the name of the scenario
RIGHT = 2e-3  # m: an estimate that ends in another minimum is off by centimetres
WHO = (
    "nominal",
    "plain least squares",
    "robotkinecal",
    *(FIGAROH + method for method in ("structural", "map", "map_cv")),
    "recalib, geometry",
    OURS,
)
TITLES = {"panda": "Panda", "ur10": "UR10", "ur10_outliers": "UR10, outliers"}
REAL = {f"ur5_{count}": "real UR5" for count in SUBSETS}
ROWS = dict.fromkeys(TITLES, POSES) | {f"ur5_{count}": count for count in SUBSETS}


def context(errors: pd.DataFrame, versions: Mapping[str, str]) -> dict:
    """The context of the template.

    Args:
        errors: a row for each scenario, draw and who: error_mm, none if the method failed.
        versions: of the peers.
    """
    rows = errors[errors.scenario != UNKNOWN_FRAMES]
    shown = [name for name in TITLES | REAL if name in {*rows.scenario}]
    text = (HERE / "features.yaml").read_text(encoding="utf-8")
    features = yaml.load(text, yaml.BaseLoader)  # other loaders read "no" as false
    return {
        "versions": versions,
        "scenarios": [_scenario(name, rows[rows.scenario == name]) for name in shown],
        "real": any(name in REAL for name in shown),
        "errors": {
            who: [_cell(rows[(rows.scenario == name) & (rows.who == who)]) for name in shown]
            for who in WHO
        },
        "unknown_frames": _counts(errors[errors.scenario == UNKNOWN_FRAMES]),
        "right": f"{1e3 * RIGHT:g}",
        "features": features,
    }


def _scenario(name: str, rows: pd.DataFrame) -> dict:
    means = rows.groupby("who").error_mm.mean()
    best = means[means.index.str.startswith(FIGAROH)].min()
    return {
        "title": (TITLES | REAL)[name],
        "draws": rows.draw.nunique(),
        "rows": ROWS[name],
        "ratio": "-" if pd.isna(best) else f"{means[OURS] / best:.2f}",
    }


def _cell(rows: pd.DataFrame) -> str:
    """The mean and the worst error; how many draws failed."""
    if rows.empty:
        return "-"
    good, failed = rows.error_mm.dropna(), int(rows.error_mm.isna().sum())
    if good.empty:
        return "nothing"
    text = _short(good.mean()) + (f" ({_short(good.max())})" if len(good) > 1 else "")
    return text + (f", {failed} failed" if failed else "")


def _short(error: float) -> str:
    return f"{error:.3f}" if error < 1 else f"{error:.2f}" if error < 10 else f"{error:.0f}"


def _counts(rows: pd.DataFrame) -> list[dict]:
    """How many draws of each method are right."""
    return [
        {"who": who, "right": int((draws.error_mm < 1e3 * RIGHT).sum()), "of": len(draws)}
        for who in WHO
        if len(draws := rows[rows.who == who])
    ]


def render(errors: pd.DataFrame, versions: Mapping[str, str]) -> str:
    """The text of the page."""
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined, keep_trailing_newline=True)
    template = environment.from_string((HERE / "page.md.j2").read_text(encoding="utf-8"))
    return template.render(context(errors, versions))
