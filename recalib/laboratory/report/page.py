"""The HTML page of a calibration: one file that loads nothing else."""

from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from recalib.laboratory.calibrate import Calibrated
from recalib.laboratory.report.drawings import COLOURS, draw_arm, draw_errors, draw_over_joints
from recalib.laboratory.report.parameters import described
from recalib.laboratory.report.summary import errors_table, notes, verdict

LISTED = 15  # parameters, the surest first


def write_html(path: Path, template: str, **values: Any) -> None:
    """Write a page from a template and the values in it."""
    environment = Environment(
        loader=PackageLoader("recalib.laboratory.report", "."),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    path.write_text(environment.get_template(template).render(values), encoding="utf-8")


def write_page(path: Path, result: Calibrated) -> None:
    """Write the page of a calibration."""
    parameters = described(result)
    decided = [its for its in parameters if its.decided_by == "data"]
    decided.sort(key=lambda its: -abs(its.value) / its.deviation)
    arm_drawing, longer = draw_arm(result)
    write_html(
        path,
        "page.html.j2",
        result=result,
        verdict=verdict(result),
        notes=notes(result),
        errors=errors_table(result),
        errors_drawing=draw_errors(result),
        joints_drawing=draw_over_joints(result),
        arm_drawing=arm_drawing,
        longer=longer,
        colours={name: COLOURS[name] for name in result.residuals},
        parameters=decided[:LISTED],
        decided=len(decided),
        undecided=len(parameters) - len(decided),
    )
