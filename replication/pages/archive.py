"""The archive: code, results, recordings and article in one file, with their metadata.

`python -m replication.pages.archive results/archive.zip` packs the committed files and the results
of the shipped study as an RO-Crate. For each result it lists the job, its inputs, start and end.
The same results give the same bytes.
"""

import base64
import hashlib
import json
import mimetypes
import subprocess
import sys
import zipfile
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

import yaml
from rocrate.model import ContextEntity, Person
from rocrate.rocrate import ROCrate

import recalib
from recalib.files.storage import whole
from replication.config import shipped
from replication.plots.figures import APART

RESULTS, PUBLISHED = Path(shipped.RESULTS), Path("published")  # folders here and in the archive
NOTES = Path(".snakemake/metadata")  # Snakemake's records of the files that it made
CHOSEN = (
    "summary.csv",
    "claims.json",
    "SHA256SUMS",
    "check.txt",
    "article.pdf",
    "figures/*",
    "mapping/*",
    "ensemble.parquet",
    "robots/*/*.json",
    "runs/*/*/*.parquet",
    "recordings/*.rrd",
)
REPEATABLE = {".csv", ".json", ".parquet", ".svg"}  # identical bytes in every run
NOT_MADE = {figure.file for figure in APART}  # by the default target
PROFILES = {
    "https://w3id.org/ro/wfrun/process/0.5": "Process Run Crate",
    "https://w3id.org/ro/wfrun/workflow/0.5": "Workflow Run Crate",
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0": "Workflow RO-Crate",
}
LICENCE = "https://spdx.org/licenses/MIT"
MOMENT = (1980, 1, 1, 0, 0, 0)  # time stamp of all files in the archive


def committed() -> list[Path]:
    """The files that are tracked by git."""
    listed = subprocess.run(["git", "ls-files", "-z"], check=True, capture_output=True, text=True)
    return sorted(Path(name) for name in listed.stdout.split("\0") if Path(name).is_file())


def chosen() -> list[Path]:
    """The results to archive."""
    return sorted(path for pattern in CHOSEN for path in RESULTS.glob(pattern) if path.is_file())


def checksums() -> str:
    """Input of `sha256sum --check` for the results that are identical in every run."""
    return "".join(
        f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.relative_to(RESULTS)}\n"
        for path in chosen()
        if path.suffix in REPEATABLE and path.stem not in NOT_MADE
    )


def _moment(seconds: float) -> str:
    return datetime.fromtimestamp(seconds, UTC).isoformat(timespec="seconds")


def crate_of(citation: Mapping[str, Any]) -> ROCrate:
    """The archive's metadata: the workflow, the files, and the run that made them."""
    crate = ROCrate(version="1.1")  # the version that the profiles of runs require
    crate.name = citation["title"]
    crate.description = "Code, results, recordings and article of a replication, and its run."
    licence = {"@type": "CreativeWork", "name": "MIT"}
    crate.license = crate.add(ContextEntity(crate, LICENCE, licence))
    for address, name in PROFILES.items():
        profile = {
            "@type": ["CreativeWork", "Profile"],
            "name": name,
            "version": address.rpartition("/")[-1],
        }
        entity = crate.add(ContextEntity(crate, address, profile))
        crate.root_dataset.append_to("conformsTo", entity)
    crate.root_dataset["author"] = [
        crate.add(Person(crate, f"#{author['name']}", {"name": author["name"]}))
        for author in citation["authors"]
    ]
    crate.add_workflow(
        "Snakefile",
        "Snakefile",
        properties={"name": "The replication", "license": LICENCE},
        main=True,
        lang="snakemake",
        lang_version=version("snakemake"),
    )
    code = {path: path for path in committed() if path != Path("Snakefile")}
    results = {path: PUBLISHED / path.relative_to(RESULTS) for path in chosen()}
    for path, place in (code | results).items():
        kind = mimetypes.guess_type(path.name)[0] or "application/octet-stream"
        properties = {"encodingFormat": kind, "contentSize": str(path.stat().st_size)}
        crate.add_file(path, place.as_posix(), properties=properties)
    _add_run(crate, results)
    return crate


def _add_run(crate: ROCrate, results: Mapping[Path, Path]) -> None:
    """Add an action for the whole run, and one for each job whose results are archived."""
    notes = [
        (Path(base64.b64decode(path.name).decode()), json.loads(path.read_text(encoding="utf-8")))
        for path in sorted(NOTES.iterdir())
    ]
    noted = [(path, note) for path, note in notes if path in results and note["endtime"]]
    first = min(note["starttime"] for _, note in noted)
    last = max(note["endtime"] for _, note in noted)
    crate.datePublished = datetime.fromtimestamp(last, UTC)
    workflow, authors = crate.mainEntity, crate.root_dataset["author"]
    properties = {"name": "A run of the workflow", "agent": authors}
    properties |= {"startTime": _moment(first), "endTime": _moment(last)}
    entities = [crate.dereference(place.as_posix()) for place in results.values()]
    actions = [crate.add_action(workflow, "#run", result=entities, properties=properties)]
    tools = {}
    for path, note in noted:
        if (rule := note["rule"]) not in tools:
            tool = {"@type": "SoftwareApplication", "name": f"rule {rule}", "url": workflow.id}
            tool["version"] = recalib.__version__
            tools[rule] = crate.add(ContextEntity(crate, f"#rule-{rule}", tool))
        read = [results.get(Path(name), Path(name)).as_posix() for name in note["input"]]
        job = crate.add_action(
            tools[rule],
            f"#job-{path.as_posix()}",
            object=[entity for name in read if (entity := crate.dereference(name))],
            result=crate.dereference(results[path].as_posix()),
            properties={
                "name": f"{rule}: {path.as_posix()}",
                "startTime": _moment(note["starttime"]),
                "endTime": _moment(note["endtime"]),
            },
        )
        actions.append(job)
    crate.root_dataset["mentions"] = actions


def pack(archive: Path) -> None:
    """Write the archive."""
    citation = yaml.safe_load(Path("CITATION.cff").read_text(encoding="utf-8"))
    with whole(RESULTS / "SHA256SUMS") as path:
        path.write_text(checksums(), encoding="utf-8")
    crate, top = crate_of(citation), f"recalib-{recalib.__version__}"
    with whole(archive) as path, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as file:
        text = json.dumps(crate.metadata.generate(), indent=1) + "\n"
        _put(file, f"{top}/ro-crate-metadata.json", text.encode())
        for entity in crate.data_entities:
            if getattr(entity, "source", None):
                _put(file, f"{top}/{entity.id}", Path(entity.source).read_bytes())


def _put(file: zipfile.ZipFile, name: str, content: bytes) -> None:
    info = zipfile.ZipInfo(name, MOMENT)
    info.compress_type, info.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
    file.writestr(info, content)


if __name__ == "__main__":
    pack(Path(sys.argv[1]))
