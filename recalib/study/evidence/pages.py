"""README and findings, rendered from templates: no measured number in them is typed."""

import json
from pathlib import Path

import jinja2
import numpy as np
import pandas as pd

from recalib.study.evidence.results import ERRORS, Evidence

UNITS = ("cm", "degrees")


def n(value: float, digits: int = 2) -> str:
    """A number for people."""
    if 0 < abs(value) < 10**-digits:
        return _rounding(value) or f"{value:.1e}"
    return f"{value:.{digits}f}"


def _rounding(value: float) -> str:
    """Says of a number that it is what the arithmetic leaves, which differs from machine to machine."""
    return "below 1e-6" if 0 < abs(value) < 1e-6 else ""


def pair(row, moment: str) -> str:
    """Both errors of a summary's row at the beginning or the end."""
    return ", ".join(
        f"{n(row[f'{moment}_{error}'])} {unit}" for error, unit in zip(ERRORS, UNITS, strict=True)
    )


def measured(claim: dict) -> str:
    """What was measured for a claim, with intervals."""

    def number(value) -> str:
        return "more" if value is None else _rounding(value) or f"{value:.3g}"

    def text(label, value) -> str:
        if label not in claim["interval"]:
            return f"{label}: {number(value)}"
        low, high = claim["interval"][label]
        return f"{label}: {number(value)} ({number(low)} to {number(high)})"

    return "; ".join(text(label, value) for label, value in claim["measured"].items())


def _ensemble(evidence: Evidence) -> dict:
    ours, ritters = (
        evidence.ensemble(learner, "assignments") for learner in ("improved", "ritter")
    )
    iterations = evidence.config["learners"]["ritter"]["iterations"]
    cells = {"robots": len(ours), "ritter_robots": len(ritters), "ritter_iterations": iterations}
    same = ours[ours["robot"].isin(ritters["robot"])]
    for error, unit in zip(ERRORS, ("cm", "deg"), strict=True):
        final = ours[f"final_{error}"]
        cells |= {f"median_{unit}": final.median(), f"p95_{unit}": final.quantile(0.95)}
        cells |= {
            f"{name}_{unit}": of[f"final_{error}"].median()
            for name, of in (("ritter", ritters), ("same", same))
        }
    return cells


def _scaled(evidence: Evidence) -> list[dict]:
    rows = []
    for scale, table in evidence.ensemble("improved", "scaled").groupby("scale"):
        cells = {"scale": scale}
        for moment in ("initial", "final"):
            for error, unit in zip(ERRORS, ("cm", "deg"), strict=True):
                cells[f"{moment}_{unit}"] = table[f"{moment}_{error}"].median()
        cells["left"] = max(
            cells[f"final_{unit}"] / cells[f"initial_{unit}"] for unit in ("cm", "deg")
        )
        rows.append(cells)
    return rows


def _refused(summary: pd.DataFrame) -> str:
    rows = summary[summary["refused"] > 0]
    cases = (
        f"{row.refused:,} of {row.moves * row.seeds:,} for {row.learner} on {row.scenario}"
        for row in rows.itertuples()
    )
    return "; ".join(cases) or "none"


def context(evidence: Evidence, pictures: bool) -> dict:
    """Everything that the templates may say."""
    summary = pd.read_csv(evidence.results / "summary.csv").replace({np.nan: None})
    rows = {(row.scenario, row.learner): row for row in summary.itertuples()}
    described = json.loads((evidence.results / "scenarios" / f"{evidence.paper}.json").read_text())
    scenarios, plan = evidence.config["scenarios"], evidence.config["search"]
    return {
        "n": n,
        "pair": pair,
        "measured": measured,
        "row": lambda *key: rows[key],
        "final": lambda *key: pair(rows[key]._asdict(), "final"),
        "summary": summary.to_dict("records"),
        "claims": evidence.claims(),
        "published": evidence.published,
        "pictures": pictures,
        "damages": "; ".join(" ".join(each.values()) for each in described["damages"]),
        "assignments": len(evidence.assignments()),
        "translation": ", ".join(scenarios["translation"][0]["translate"]),
        "rotation": ", ".join(scenarios["rotation"][0]["rotate"]),
        "refused": _refused(summary),
        "trials": plan["rounds"] * plan["trials"],
        "ensemble": _ensemble(evidence),
        "scaled": _scaled(evidence),
        "scaled_robots": evidence.ensemble("improved", "scaled")["robot"].nunique(),
    }


def render(template: str | Path, context: dict) -> str:
    """The text of a page."""
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined, keep_trailing_newline=True)
    return environment.from_string(Path(template).read_text()).render(context)
