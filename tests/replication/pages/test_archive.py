"""The archive has metadata for machines, and always the same bytes."""

import base64
import json
import shutil
import zipfile
from importlib.resources import files
from pathlib import Path

import pytest

from tests.conftest import ROOT, run

pytest.importorskip("rocrate")
from replication.pages import archive

FEW = "Snakefile", "config.yaml", "README.md", "CITATION.cff", "LICENSE"
TERM = b"https://bioschemas.org/terms/ComputationalWorkflow"


@pytest.fixture
def folder(study, project, monkeypatch) -> Path:
    """A few files of the project, synthetic results, and what Snakemake notes of them."""
    root = project(study, 5)
    monkeypatch.chdir(root)
    for name in FEW:
        shutil.copy(ROOT / name, root)
    run("git", "init", "--quiet", cwd=root, check=True)
    run("git", "add", *FEW, cwd=root, check=True)
    archive.NOTES.mkdir(parents=True)
    times = {"starttime": 1e9, "endtime": 1e9 + 5}
    note = {"rule": "claims", "input": ["results/summary.csv"]} | times
    name = base64.b64encode(b"results/claims.json").decode()
    (archive.NOTES / name).write_text(json.dumps(note), encoding="utf-8")
    drawn = root / "results" / "figures"
    drawn.mkdir(exist_ok=True)
    for name in ("figure1.svg", "figure8.svg"):  # that of the study, and that of the benchmark
        (drawn / name).write_text("<svg/>", encoding="utf-8")
    return root


@pytest.fixture
def unpacked(folder, tmp_path_factory):
    """The folder that a stranger unpacks, and what it says of itself."""
    archive.pack(folder / "archive.zip")
    elsewhere = tmp_path_factory.mktemp("unpacked")
    with zipfile.ZipFile(folder / "archive.zip") as packed:
        packed.extractall(elsewhere)
    (root,) = elsewhere.iterdir()
    return root


def graph(folder) -> dict[str, dict]:
    text = (folder / "ro-crate-metadata.json").read_text(encoding="utf-8")
    return {entity["@id"]: entity for entity in json.loads(text)["@graph"]}


def test_the_same_results_give_the_same_bytes(folder):
    for name in ("one.zip", "two.zip"):
        archive.pack(folder / name)
    assert (folder / "one.zip").read_bytes() == (folder / "two.zip").read_bytes()


def test_all_that_is_named_is_there_and_the_job_of_a_result_is_said(unpacked):
    known = graph(unpacked)
    named = [part["@id"] for part in known["./"]["hasPart"]]
    assert {*FEW, "published/claims.json", "published/summary.csv"} <= {*named}
    assert all((unpacked / name).is_file() for name in named)
    job = known["#job-results/claims.json"]
    assert job["result"] == {"@id": "published/claims.json"}
    assert job["object"] == [{"@id": "published/summary.csv"}]
    assert known[job["instrument"]["@id"]]["name"] == "rule claims"
    assert job["startTime"] == "2001-09-09T01:46:40+00:00"


def test_checksums_tell_which_results_another_run_has_to_give(unpacked):
    published = unpacked / "published"
    check = "sha256sum", "--check", "--quiet", "SHA256SUMS"
    assert run(*check, cwd=published).returncode == 0
    listed = (published / "SHA256SUMS").read_text(encoding="utf-8")
    assert "figure1.svg" in listed
    assert "figure8.svg" not in listed  # `make` does not draw it
    assert "  claims.json\n" in listed and "  summary.csv\n" in listed
    (published / "claims.json").write_text("[]", encoding="utf-8")
    spoilt = run(*check, cwd=published)
    assert spoilt.returncode != 0 and "claims.json: FAILED" in spoilt.stdout


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # of rdflib, by its own callers
@pytest.mark.slow  # the rules of the profiles take half a minute
def test_the_validator_of_ro_crate_finds_nothing(unpacked, monkeypatch):
    requests = pytest.importorskip("requests")
    models = pytest.importorskip("rocrate_validator.models")
    from rocrate_validator import services

    # Version 1.1 of the context is not packaged. 1.3 is, and names one term of ours otherwise.
    context = (files("rocrate") / "data" / "ro-crate.jsonld").read_bytes()
    context = context.replace(TERM, TERM.replace(b"terms/", b""))

    def get(self, url, **_):
        answer = requests.Response()
        answer.status_code, answer._content, answer.url = 200, context, url
        answer.headers["Content-Type"] = "application/ld+json"
        return answer

    monkeypatch.setattr(requests.Session, "get", get)
    for profile in ("ro-crate-1.1", "workflow-run-crate-0.5"):
        settings = models.ValidationSettings(
            rocrate_uri=str(unpacked), profile_identifier=profile, no_cache=True
        )
        assert [issue.message for issue in services.validate(settings).get_issues()] == []
