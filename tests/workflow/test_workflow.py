"""The whole workflow on a small study, in a copy of the project."""

import fcntl
import subprocess

import numpy as np
import pandas as pd
import pytest

from recalib.loading import load
from recalib.study.competitors import make_peer
from recalib.study.experiments.poses import Stream, train_for_results
from recalib.study.plants import Resolved
from tests.conftest import ROOT, copy_project
from tests.workflow.conftest import TINY, snakemake
from workflow import alone

pytestmark = pytest.mark.slow
shared = pytest.mark.xdist_group(name="workflow")  # one after the other: they share the copy


def planned(project, *arguments) -> set[str]:
    """The rules that would run."""
    lines = snakemake(project, "-n", *arguments).stdout.splitlines()
    start = lines.index("Job stats:") if "Job stats:" in lines else len(lines)
    rows = [line.split() for line in lines[start + 3 :]]
    return {row[0] for row in rows[: rows.index([])] if row[0] != "total"} if [] in rows else set()


def digests(project, *folders) -> dict[str, bytes]:
    """What the committed files hold."""
    paths = (path for folder in folders for path in sorted((project / folder).rglob("*")))
    return {str(path.relative_to(project)): path.read_bytes() for path in paths if path.is_file()}


@shared
def test_a_killed_run_goes_on_and_what_was_done_is_kept(killed, continued):
    assert killed.done and continued == killed.folder
    for path, then in killed.done.items():
        assert path.stat().st_mtime_ns == then


@shared
def test_the_contract_of_the_outputs_holds(continued):
    results = continued / TINY
    for scenario in ("intact", "links_encoders"):
        resolved = Resolved.read(results / "scenarios" / f"{scenario}.json")
        assert (results / "recordings" / f"{scenario}.rrd").stat().st_size > 1e6
        for learner in ("improved", "ritter"):
            history = pd.read_parquet(results / "runs" / scenario / f"{learner}.parquet")
            searches = 2 if learner == "ritter" else 3  # it is a long training
            runs = history.groupby("search")["seed"].unique().map(sorted).tolist()
            assert runs == [[2 * number, 2 * number + 1] for number in range(searches)]
            learned = load(
                results / "runs" / scenario / f"{learner}.npz", resolved.controller().robot
            )
            assert len(learned.state()) == 2 * searches
    summary = pd.read_csv(results / "summary.csv")
    assert len(summary) == 4 and (summary["moves"] == 2 * summary["iterations"]).all()
    assert "intact" in (results / "check.txt").read_text(encoding="utf-8")
    for figure in ("figure1", "figure2", "figure3"):
        for suffix in (".svg", ".png"):
            assert (results / "figures" / f"{figure}{suffix}").stat().st_size > 5000


@shared
def test_a_study_of_another_name_keeps_out_of_what_is_committed(continued):
    committed = "figures", "docs", "workflow/search"
    assert digests(continued, *committed) == digests(ROOT, *committed)
    assert (continued / "README.md").read_bytes() == (ROOT / "README.md").read_bytes()
    assert not list((continued / "results").glob("*.csv"))


@shared
def test_an_edited_module_reruns_what_depends_on_it_and_only_that(continued):
    module = continued / "recalib" / "study" / "plots" / "learning.py"
    text = module.read_text(encoding="utf-8")
    module.write_text(text + "# edited\n", encoding="utf-8")
    assert planned(continued) == {"all", "figure", "report_pages_tiny"}
    module.write_text(text, encoding="utf-8")
    assert planned(continued) == set(), "nothing was left to do before"


@shared
def test_an_edited_setting_reruns_what_depends_on_it_and_only_that(continued):
    fewer = planned(continued, "--config", "training={tests: 10}")
    assert {"search", "train_chunk", "summary", "figure", "recording"} <= fewer
    assert not {"scenario", "assignments"} & fewer
    assert planned(continued) == set()


@shared
def test_the_same_configuration_gives_the_same_bytes(continued):
    run = "runs/links_encoders/improved"
    files = [f"{run}.parquet", f"{run}.npz"]
    again = snakemake(
        continued,
        "--config",
        "name=again",
        "--",
        *(f"results/studies/again/{file}" for file in files),
    )
    assert again.returncode == 0, again.stdout
    for file in files:
        second = continued / "results/studies/again" / file
        assert second.read_bytes() == (continued / TINY / file).read_bytes()


def test_a_scenario_of_the_benchmark_is_the_same_alone_and_beside_others(tmp_path):
    project = copy_project(tmp_path)
    chosen = "benchmark={scenarios: [translation, noise]}"
    finished = snakemake(project, "--config", chosen, "--", f"{TINY}/benchmark.csv")
    assert finished.returncode == 0, finished.stdout
    table = pd.read_csv(project / TINY / "benchmark.csv").set_index(["scenario", "moves"])
    assert table.index.tolist() == [
        ("translation", 1),
        ("translation", 2),
        ("noise", 1),
        ("noise", 2),
    ]
    resolved, seed = Resolved.read(project / TINY / "scenarios" / "noise.json"), 1996
    controller, runs = resolved.controller(), range(2)
    alone = train_for_results(
        resolved.plant(controller, seed, runs),
        make_peer("affine", 2, controller),
        Stream.SCENARIO.draw(seed, runs, 2, 20, scenario="noise"),
        [1, 2],
    )
    means = 100 * alone.position[..., 0].mean(axis=0)
    assert np.allclose(table.loc["noise", "position_error_cm"], means, rtol=1e-5), "six digits"


@shared
def test_the_search_gives_the_same_file_with_the_same_trials_for_all(continued):
    again = "results/studies/again/search/improved_60.csv"
    finished = snakemake(continued, "--config", "name=again", "--", again)
    assert finished.returncode == 0, finished.stdout
    for training, searches in (("improved_60", 3), ("ritter_120", 2)):
        sample = continued / TINY / "search" / f"{training}.csv"
        trials = pd.read_csv(sample, skiprows=1).groupby(["search", "round"]).size()
        assert trials.tolist() == [4] * 2 * searches
        assert training != "improved_60" or (continued / again).read_bytes() == sample.read_bytes()


@shared
def test_a_final_error_outside_of_its_band_ends_the_run_with_its_name(continued):
    """That an error in a learning rule is one, tests/study/experiments/test_planted.py shows."""
    bands = pd.read_csv(continued / "tests" / "tiny" / "expected.csv")
    wrong = continued / "wrong.csv"
    bands.assign(low=bands["low"] + 10, high=bands["high"] + 10).to_csv(wrong, index=False)
    check = f"{TINY}/check.txt"
    broken = snakemake(continued, "--config", f"expected={wrong}", "--", check)
    assert broken.returncode != 0
    assert "links_encoders improved: position_error_cm is" in broken.stdout
    assert snakemake(continued, "--", check).returncode == 0


@shared
def test_bad_input_stops_before_anything_runs(continued):
    refused = snakemake(continued, "-n", "--config", "experiments={learners: [improve]}")
    assert refused.returncode != 0
    assert (
        "experiments.learners[0]" in refused.stdout and "did you mean improved?" in refused.stdout
    )


@pytest.fixture
def checkout(tmp_path):
    """A copy of the project in git, so that what changes is seen."""
    project = copy_project(tmp_path)
    for command in (["init", "-q"], ["add", "."], ["commit", "-qm", "as it was"]):
        identity = "-c", "user.name=test", "-c", "user.email=test@localhost"
        subprocess.run(["git", *identity, *command], cwd=project, check=True)
    return project


def test_another_value_under_the_shipped_name_is_refused_and_changes_nothing(checkout):
    config = checkout / "config.yaml"
    text = config.read_text(encoding="utf-8")
    config.write_text(text.replace("\nrobot: ur10", "\nrobot: ur3"), encoding="utf-8")
    refused = snakemake(checkout, "--", "figures/figure1.svg", small=False)
    assert refused.returncode != 0
    assert "not the shipped study: it differs in robot" in refused.stdout
    config.write_text(text, encoding="utf-8")
    status = subprocess.run(
        ["git", "status", "--porcelain"], cwd=checkout, capture_output=True, text=True, check=True
    )
    assert status.stdout == ""


@shared
def test_a_second_run_in_a_folder_of_results_is_told_to_wait(continued):
    again = "--forcerun", "check", "--", f"{TINY}/check.txt"
    with (continued / TINY / alone.MARK).open("a", encoding="utf-8") as mark:
        fcntl.flock(mark, fcntl.LOCK_EX)
        before = (continued / TINY / "check.txt").stat().st_mtime_ns
        waiting = snakemake(continued, *again)
        assert waiting.returncode != 0
        assert f"another run is at work in {TINY}: wait until it has ended" in waiting.stdout
        assert (continued / TINY / "check.txt").stat().st_mtime_ns == before
        elsewhere = "results/studies/elsewhere/scenarios/intact.json"
        assert snakemake(continued, "--config", "name=elsewhere", "--", elsewhere).returncode == 0
    assert snakemake(continued, *again).returncode == 0
