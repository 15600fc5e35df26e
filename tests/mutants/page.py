"""The page on how many mutants the tests notice, and which they do not."""

import difflib
from collections.abc import Mapping
from pathlib import Path

import jinja2
import yaml
from cosmic_ray.work_db import use_db
from cosmic_ray.work_item import WorkItem, WorkResult
from scipy.stats import binomtest

HERE = Path(__file__).parent
PAGE, UNEXPLAINED = HERE.parents[1] / "docs" / "mutants.md", HERE / "unexplained.diff"


def difference(before: str, after: str) -> str:
    """The lines that differ, each behind its sign."""
    lines = difflib.unified_diff(before.splitlines(), after.splitlines(), n=0, lineterm="")
    return "\n".join(line for line in lines if not line.startswith(("---", "+++", "@@")))


def _survivor(item: WorkItem, result: WorkResult, reasons: Mapping) -> dict:
    module, lines = str(item.mutations[0].module_path), result.diff.splitlines()
    was, now = (
        " ".join(line[1:].strip() for line in lines if line.startswith(sign)) for sign in "-+"
    )
    reason = reasons.get((module, was, now), "")
    line = item.mutations[0].start_pos[0]
    return {"module": module, "line": line, "was": was, "now": now, "reason": reason}


def write_page(sessions: Mapping[str, Path]) -> None:
    """Write the results of the sessions of cosmic-ray, by the part of the project."""
    explained = yaml.safe_load((HERE / "survivors.yaml").read_text(encoding="utf-8")) or []
    reasons = {(entry["module"], entry["was"], entry["now"]): entry["why"] for entry in explained}
    rows, survivors = [], []
    for part, path in sessions.items():
        with use_db(path) as mutants:
            judged = [pair for pair in mutants.completed_work_items if pair[1].test_outcome]
            survived = [_survivor(*pair, reasons) for pair in judged if not pair[1].is_killed]
            row = {"of": mutants.num_work_items, "judged": len(judged), "survived": len(survived)}
        row["explained"] = sum(bool(survivor["reason"]) for survivor in survived)
        if judged:
            rows.append(row | {"part": part, "interval": _interval(row)})
        survivors += sorted(survived, key=lambda survivor: (survivor["module"], survivor["line"]))
    whole = {key: sum(row[key] for row in rows) for key in row}
    template = jinja2.Template((HERE / "page.md.j2").read_text(encoding="utf-8"))
    page = template.render(rows=rows, whole=whole | {"interval": _interval(whole)})
    PAGE.write_text(page + "\n", encoding="utf-8")
    changes = (
        "# {module}, line {line}\n- {was}\n+ {now}\n".format(**survivor)
        for survivor in survivors
        if not survivor["reason"]
    )
    UNEXPLAINED.write_text("".join(changes), encoding="utf-8")


def _interval(row: Mapping) -> str:
    if not row["judged"]:
        return "-"
    interval = binomtest(row["survived"], row["judged"]).proportion_ci(method="wilson")
    return f"{100 * interval.low:.0f} to {100 * interval.high:.0f} %"
