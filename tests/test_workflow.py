"""The whole workflow on a small configuration, in a copy of the project."""

import numpy as np
import pandas as pd
import pytest

from recalib.study.experiments import campaign
from recalib.study.experiments.benchmark import entrant
from recalib.training import train
from tests.conftest import copy_project, snakemake

shared = pytest.mark.xdist_group(name="workflow")  # one after the other: they share the copy


def planned(project, *arguments) -> set[str]:
    """The rules that would run."""
    lines = snakemake(project, "-n", *arguments).stdout.splitlines()
    start = lines.index("Job stats:") if "Job stats:" in lines else len(lines)
    rows = [line.split() for line in lines[start + 3 :]]
    return {row[0] for row in rows[: rows.index([])] if row[0] != "total"} if [] in rows else set()


@shared
def test_the_contract_of_the_outputs_holds(project):
    results = project / "results"
    for scenario in ("intact", "links_encoders"):
        assert (results / "scenarios" / f"{scenario}.json").exists()
        assert (results / "recordings" / f"{scenario}.rrd").stat().st_size > 1e6
        for learner in ("improved", "ritter", "ritter_200"):
            history = pd.read_parquet(results / "runs" / scenario / f"{learner}.parquet")
            assert sorted(history["seed"].unique()) == list(
                range(3 if learner == "improved" else 2)
            )
            assert (results / "runs" / scenario / f"{learner}.npz").exists()
    summary = pd.read_csv(results / "summary.csv")
    assert len(summary) == 6 and (summary["moves"] == 2 * summary["iterations"]).all()
    assert "intact" in (results / "check.txt").read_text()
    for figure in ("figure1", "figure2", "figure3"):
        for suffix in (".svg", ".png"):
            assert (project / "figures" / f"{figure}{suffix}").stat().st_size > 5000


@shared
def test_an_edited_module_reruns_what_depends_on_it_and_only_that(project):
    module = project / "recalib" / "plots" / "learning.py"
    text = module.read_text()
    module.write_text(text + "# edited\n")
    assert planned(project) == {"all", "figure", "report_pages"}
    module.write_text(text)
    assert planned(project) == set(), "nothing was left to do before"


@shared
def test_an_edited_setting_reruns_what_depends_on_it_and_only_that(project):
    settings = project / "tests" / "tiny" / "settings.yaml"
    text = settings.read_text()
    settings.write_text(text.replace("initial_width: 0.5", "initial_width: 0.6"))
    rules = planned(project)
    assert {"train", "run", "summary", "figure"} <= rules and not {
        "scenario",
        "assignments",
    } & rules
    settings.write_text(text)


@shared
def test_the_same_configuration_gives_the_same_bytes(project):
    run = "runs/links_encoders/improved"
    files = [f"again/{run}.parquet", f"again/{run}.npz", "again/figure1.svg", "again/figure1.png"]
    again = snakemake(project, "--config", "results=again", "figures=again", "--", *files)
    assert again.returncode == 0, again.stdout
    for file in files:
        first = project / file.replace("again/", "figures/" if "figure" in file else "results/")
        assert (project / file).read_bytes() == first.read_bytes()


def test_a_scenario_of_the_benchmark_is_the_same_alone_and_beside_others(tmp_path, config):
    project = copy_project(tmp_path)
    finished = snakemake(
        project,
        "--config",
        "benchmark={scenarios: [translation, noise]}",
        "--",
        "results/benchmark.csv",
    )
    assert finished.returncode == 0, finished.stdout
    table = pd.read_csv(project / "results" / "benchmark.csv").set_index(["scenario", "moves"])
    assert table.index.tolist() == [
        ("translation", 1),
        ("translation", 2),
        ("noise", 1),
        ("noise", 2),
    ]
    runs = range(2)
    controller, plant = campaign.load_plant(
        project / "results" / "scenarios" / "noise.json", config, runs
    )
    desired = campaign.desired_poses(config["seed"], "noise", runs, 2)
    tests = campaign.test_poses(config["seed"], "noise", runs, 20)
    alone = train(plant, entrant("affine", config).make(2, controller), desired, tests, [1, 2])
    # the table has six digits
    assert np.allclose(
        table.loc["noise", "position_error_cm"],
        100 * alone.position[..., 0].mean(axis=0),
        rtol=1e-5,
    )


def test_the_search_gives_the_same_file_with_the_same_trials_for_all(tmp_path):
    project, files = copy_project(tmp_path), []
    for folder in ("first", "second"):
        config = f"tuned={folder}", "experiments={learners: [improved, ritter]}"
        finished = snakemake(
            project, "--forcerun", "search_trials", "--config", *config, "--", "tune"
        )
        assert finished.returncode == 0, finished.stdout
        files.append(
            [(project / folder / name).read_text() for name in ("settings.yaml", "trials.csv")]
        )
    assert files[0] == files[1]
    assert set(pd.read_csv(project / "first" / "trials.csv").groupby("training").size()) == {4}


@shared
def test_a_wrong_sign_in_a_learning_rule_turns_the_check_red(project):
    module = project / "recalib" / "learners" / "hierarchical.py"
    text = module.read_text()
    right = "miss = desired - first.achieved[:, 0]"
    assert right in text
    module.write_text(text.replace(right, "miss = first.achieved[:, 0] - desired"))
    broken = snakemake(
        project,
        "--config",
        "experiments={scenarios: [links_encoders], learners: [improved]}",
        "--",
        "check",
    )
    module.write_text(text)
    assert broken.returncode != 0
    assert (
        "links_encoders improved: position_error_cm is" in broken.stdout
        and "expected 0.2" in broken.stdout
    )


@shared
def test_bad_input_stops_before_anything_runs(project):
    refused = snakemake(project, "-n", "--config", "experiments={learners: [improve]}")
    assert (
        refused.returncode != 0 and "unknown learner 'improve'; valid: improved," in refused.stdout
    )
