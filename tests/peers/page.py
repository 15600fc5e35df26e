"""The page that says what everybody's errors are, and what each reads, writes and checks."""

from collections.abc import Mapping
from pathlib import Path

import jinja2
import pandas as pd
import yaml

from tests.peers.tasks import POSES, SUBSETS

HERE = Path(__file__).parent
PAGE = HERE.parents[1] / "docs" / "peers.md"
OURS, OTHER, UNTOLD = "recalib", "figaroh, ", "untold"
RIGHT = 2e-3  # m: an estimate that ends in another minimum is off by centimetres
WHO = (
    "nominal",
    "plain least squares",
    "robotkinecal",
    *(OTHER + method for method in ("structural", "map", "map_cv")),
    "recalib, geometry",
    OURS,
)
TITLES = {"panda": "Panda", "ur10": "UR10", "ur10_outliers": "UR10, outliers"}
REAL = {f"ur5_{count}": "real UR5" for count in SUBSETS}
ROWS = dict.fromkeys(TITLES, POSES) | {f"ur5_{count}": count for count in SUBSETS}


def context(errors: pd.DataFrame, versions: Mapping[str, str]) -> dict:
    """What the page says.

    Args:
        errors: a row for each scenario, draw and who: error_mm, none where nothing came of it.
        versions: of the peers.
    """
    told = errors[errors.scenario != UNTOLD]
    shown = [name for name in TITLES | REAL if name in {*told.scenario}]
    text = (HERE / "features.yaml").read_text(encoding="utf-8")
    features = yaml.load(text, yaml.BaseLoader)  # to others, "no" is no word
    return {
        "versions": versions,
        "scenarios": [_scenario(name, told[told.scenario == name]) for name in shown],
        "real": any(name in REAL for name in shown),
        "errors": {
            who: [_cell(told[(told.scenario == name) & (told.who == who)]) for name in shown]
            for who in WHO
        },
        "untold": _untold(errors[errors.scenario == UNTOLD]),
        "right": f"{1e3 * RIGHT:g}",
        "features": features,
    }


def _scenario(name: str, rows: pd.DataFrame) -> dict:
    means = rows.groupby("who").error_mm.mean()
    best = means[means.index.str.startswith(OTHER)].min()
    return {
        "title": (TITLES | REAL)[name],
        "draws": rows.draw.nunique(),
        "rows": ROWS[name],
        "ratio": "-" if pd.isna(best) else f"{means[OURS] / best:.2f}",
    }


def _cell(rows: pd.DataFrame) -> str:
    """The mean and the worst; how often nothing came of it."""
    if rows.empty:
        return "-"
    good, failed = rows.error_mm.dropna(), int(rows.error_mm.isna().sum())
    if good.empty:
        return "nothing"
    text = _short(good.mean()) + (f" ({_short(good.max())})" if len(good) > 1 else "")
    return text + (f", {failed} failed" if failed else "")


def _short(error: float) -> str:
    return f"{error:.3f}" if error < 1 else f"{error:.2f}" if error < 10 else f"{error:.0f}"


def _untold(rows: pd.DataFrame) -> list[dict]:
    return [
        {"who": who, "right": int((its.error_mm < 1e3 * RIGHT).sum()), "of": len(its)}
        for who in WHO
        if len(its := rows[rows.who == who])
    ]


def render(errors: pd.DataFrame, versions: Mapping[str, str]) -> str:
    """The text of the page."""
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined, keep_trailing_newline=True)
    template = environment.from_string((HERE / "page.md.j2").read_text(encoding="utf-8"))
    return template.render(context(errors, versions))
