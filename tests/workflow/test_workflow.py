"""The whole workflow: on a small study, in a copy of the project, and on other arms."""

import re
import subprocess

import pandas as pd
import pytest
import yaml

from recalib import load
from replication.scenarios import Resolved
from tests.arms import LIBRARY
from tests.conftest import ROOT
from tests.faults.project import Project
from tests.replication.config.test_own_robots import entry_of
from tests.workflow.conftest import CORES

pytestmark = pytest.mark.slow
shared = pytest.mark.xdist_group(name="workflow")  # one after the other: they share the copy


def planned(project, *arguments) -> set[str]:
    """The rules that would run."""
    lines = project.run("-n", *arguments).expect_success().output.splitlines()
    start = lines.index("Job stats:") if "Job stats:" in lines else len(lines)
    rows = [line.split() for line in lines[start + 3 :]]
    return {row[0] for row in rows[: rows.index([])] if row[0] != "total"} if [] in rows else set()


def content(folder, *parts) -> dict[str, bytes]:
    """What the files of some folders hold."""
    paths = (path for part in parts for path in sorted((folder / part).rglob("*")))
    return {str(path.relative_to(folder)): path.read_bytes() for path in paths if path.is_file()}


@shared
def test_a_killed_run_goes_on_and_what_was_done_is_kept(killed, continued):
    assert killed.done
    for path, then in killed.done.items():
        assert path.stat().st_mtime_ns == then


@shared
def test_the_contract_of_the_outputs_holds(continued):
    results = continued.results
    for scenario in ("intact", "links_encoders"):
        resolved = Resolved.read(results / "robots" / "ur10" / f"{scenario}.json")
        assert (results / "recordings" / f"{scenario}.rrd").stat().st_size > 1e6
        for learner in ("improved", "ritter"):
            path = results / "runs" / "ur10" / scenario / learner
            history = pd.read_parquet(path.with_suffix(".parquet"))
            assert sorted(history["seed"].unique()) == [0, 1]
            learned = load(path.with_suffix(".npz"), resolved.controller().robot)
            assert len(learned.state()) == 2
    summary = pd.read_csv(results / "summary.csv")
    assert len(summary) == 4 and (summary["moves"] == 2 * summary["iterations"]).all()
    assert "intact" in (results / "check.txt").read_text(encoding="utf-8")
    for suffix in (".svg", ".png"):
        assert (results / "figures" / f"figure1{suffix}").stat().st_size > 5000


@shared
def test_a_study_of_another_name_keeps_out_of_what_is_committed(continued):
    committed = "figures", "docs", "workflow/campaign"
    assert content(continued.folder, *committed) == content(ROOT, *committed)
    assert (continued.folder / "README.md").read_bytes() == (ROOT / "README.md").read_bytes()
    assert not list((continued.folder / "results").glob("*.csv"))


@shared
def test_what_is_edited_reruns_what_depends_on_it_and_only_that(continued):
    module = continued.folder / "replication" / "plots" / "learning.py"
    text = module.read_text(encoding="utf-8")
    module.write_text(text + "# edited\n", encoding="utf-8")
    edited = planned(continued)
    module.write_text(text, encoding="utf-8")
    assert {"all", "figures"} <= edited
    assert not {rule for rule in edited if rule.startswith("train")} | {"scenarios"} & edited
    assert planned(continued) == set(), "nothing was left to do before"
    assert "scenarios" in planned(continued, "--config", "seed=2")


@shared
def test_the_same_configuration_gives_the_same_bytes(continued):
    run = "runs/ur10/links_encoders/improved"
    files = [f"{run}.parquet", f"{run}.npz", "settings/improved.csv"]
    wanted = (f"results/studies/again/{file}" for file in files)
    continued.run("--config", "name=again", "--", *wanted).expect_success()
    for file in files[:2]:  # a row of settings says how many seconds it took
        again = continued.results.with_name("again") / file
        assert again.read_bytes() == (continued.results / file).read_bytes()


@shared
def test_a_final_error_outside_of_its_band_ends_the_run_with_its_name(continued):
    bands = pd.read_csv(continued.folder / "tests" / "tiny" / "expected.csv")
    wrong = continued.folder / "wrong.csv"
    bands.assign(low=bands["low"] + 10, high=bands["high"] + 10).to_csv(wrong, index=False)
    check = "--", "results/studies/tiny/check.txt"
    broken = continued.run("--config", f"expected={wrong}", *check).expect_failure()
    named = r"improved, \d+ iterations, on the ur10, links_encoders: position_error"
    assert re.search(named, broken.output)
    continued.run(*check).expect_success()


def test_another_value_under_the_shipped_name_is_refused_and_changes_nothing(tmp_path):
    project = Project(tmp_path, *CORES)
    git = ["git", "-c", "user.name=test", "-c", "user.email=test@localhost"]
    for command in (["init", "-q"], ["add", "."], ["commit", "-qm", "as it was"]):
        subprocess.run([*git, *command], cwd=tmp_path, check=True)
    config = tmp_path / "config.yaml"
    text = config.read_text(encoding="utf-8")
    config.write_text(text.replace("\nrobot: ur10", "\nrobot: ur3"), encoding="utf-8")
    refused = project.run("--", "figures/figure1.svg")
    refused.expect_refusal("not the shipped study: it differs in robot")
    config.write_text(text, encoding="utf-8")
    assert subprocess.check_output([*git, "status", "--porcelain"], cwd=tmp_path) == b""


@pytest.mark.parametrize("urdf", ["kinova.urdf", "xarm7.urdf"])
def test_another_arm_is_damaged_trained_drawn_and_recorded(urdf, tmp_path):
    """One of six joints and one of seven, with the paper's damage."""
    row = next(row for row in LIBRARY if row["urdf"] == urdf)
    mine = {"like": "quick", "robot": "mine", "robots": {"mine": entry_of(row)}}
    mine["experiments"] = {"scenarios": ["links_encoders"], "switches": False}
    mine |= {"training": {"seeds": 2, "tests": 20}, "search": {"searches": 2}}
    project = Project(tmp_path, *CORES, "--configfile", "mine.yaml", name="mine")
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(mine), encoding="utf-8")
    project.run().expect_success()
    results = project.results
    table = pd.read_csv(results / "summary.csv").set_index("learner")
    assert {*table.index} == {"improved", "ritter"} and {*table["robot"]} == {"mine"}
    improved = table.loc["improved"]
    for error in ("position_error_cm", "orientation_error_deg"):
        assert improved[f"final_{error}"] < 0.2 * improved[f"initial_{error}"]
    assert (results / "recordings" / "links_encoders.rrd").stat().st_size > 1e5
    for made in ("claims.json", "figures/figure1.svg"):
        assert (results / made).exists()
