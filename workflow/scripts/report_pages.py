"""Write the pages of the report: texts whose numbers are filled in from the results, with their figures and tables."""

import json
import platform
from importlib.metadata import version
from pathlib import Path

import pandas as pd
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from recalib.storage import whole
from recalib.study.experiments import tuned
from workflow.scripts.job import job


def read(path):
    return json.loads(Path(path).read_text())


def inline(path):
    """A drawing as a part of the page, without what only a file of its own needs."""
    text = Path(path).read_text()
    return Markup(text[text.index("<svg") :])


with job(snakemake):
    config, summary = snakemake.config, pd.read_csv(snakemake.input.summary)
    figures = {Path(path).stem: inline(path) for path in snakemake.input.figures}
    results = {
        "config": config,
        "paper": config["search"]["scenario"],
        "runs": {(run["scenario"], run["learner"]): run for run in summary.to_dict("records")},
        "settings": lambda learner: tuned.settings(
            tuned.training(learner, config["learners"]), config["tuned"]
        ),
        "scenarios": [read(path) for path in snakemake.input.scenarios],
        "claims": {claim["id"]: claim for path in snakemake.input.claims for claim in read(path)},
        "versions": lambda *names: {
            "Python": platform.python_version(),
            **{name: version(name) for name in names},
        },
    }
    layout = Environment(
        loader=FileSystemLoader("workflow/report"), autoescape=True, undefined=StrictUndefined
    )
    for output in map(Path, snakemake.output):
        page = {"page": output.name, "figure": figures.get(output.stem)}
        with whole(output) as path:
            path.write_text(layout.get_template("layout.html").render(results | page))
