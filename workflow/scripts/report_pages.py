"""Write the pages of the report: texts with the numbers, figures and tables of the results."""

from pathlib import Path

from recalib.storage import whole
from recalib.study.evidence.needs import Needs
from recalib.study.evidence.report import KEPT, context, from_markdown, front, page
from recalib.study.evidence.results import Evidence
from workflow.scripts.job import job

with job(snakemake):
    known = context(Evidence(Needs.model_validate_json(snakemake.params.job)))
    figures = {Path(path).stem: path for path in snakemake.input.figures}
    figures |= {name: f"figures/{name}.svg" for name in KEPT.values()}
    texts = {Path(path).stem: Path(path) for path in snakemake.input.read}
    texts |= {name: Path(f"docs/{name}.md") for name in KEPT}
    for output in map(Path, snakemake.output.pages):
        if output.stem in texts:
            text = from_markdown(texts[output.stem].read_text(encoding="utf-8"), figures)
        else:
            text = page(output.stem, known, figures)
        with whole(output) as path:
            path.write_text(text, encoding="utf-8")
    with whole(snakemake.output.front) as path:
        path.write_text(front(known, figures), encoding="utf-8")
