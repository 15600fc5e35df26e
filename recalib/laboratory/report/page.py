"""The HTML page of a calibration: one file that loads nothing else."""

from recalib.laboratory.report.drawings import COLOURS, draw_arm, draw_errors, draw_over_joints
from recalib.laboratory.report.summary import errors_table, notes, verdict
from recalib.laboratory.report.templates import render
from recalib.laboratory.results import Results

LISTED = 15  # parameters, the most certain first


def page_of(result: Results) -> bytes:
    """The page of a calibration."""
    parameters = result.identified
    decided = [parameter for parameter in parameters if parameter["decided_by"] == "data"]
    decided.sort(key=lambda parameter: -abs(parameter["value"]) / parameter["deviation"])
    arm_drawing, longer = draw_arm(result)
    return render(
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
    ).encode()
