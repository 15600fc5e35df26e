"""A recording is written whole or not at all, and compared with the experiment before."""

import shutil
import subprocess

import numpy as np
import pandas as pd
import pytest
from rerun.chunk import RrdReader

from recalib.damaged.damage import LinkShortening
from recalib.damaged.disturbances import Outliers, Repeatability
from recalib.errors import InvalidFile
from recalib.laboratory.viewer.process import PROGRAM, quiet
from recalib.nominal import meshes
from recalib.study.experiments import campaign, search
from recalib.study.experiments.samples import sample_of, sought
from recalib.study.inference.intervals import typical
from recalib.study.inference.measured import ERRORS, errors_of
from recalib.study.recording import writing
from recalib.study.recording.blueprint import arrange
from recalib.study.recording.sight import sight_of
from recalib.study.recording.writing import check_end, record, write_recording
from tests.study.recording.conftest import DAMAGES, SEED, learners
from workflow.scripts import call


def rrd(*command):
    ran = subprocess.run([PROGRAM, "rrd", *command], env=quiet(), capture_output=True)
    return ran.returncode == 0


def test_a_recording_is_valid_and_small(recording):
    path, _ = recording
    check_end(path)
    assert rrd("verify", path)
    assert path.stat().st_size < 20e6


@pytest.mark.parametrize("share", [0, 0.5, 0.99])
def test_a_recording_that_ends_too_early_is_refused(recording, tmp_path, share):
    content, cut = recording[0].read_bytes(), tmp_path / "cut.rrd"
    cut.write_bytes(content[: int(share * len(content))])
    with pytest.raises(InvalidFile):
        check_end(cut)


def test_two_recordings_of_the_same_are_equal_and_a_millimetre_shows(
    recording, job, resolved, tmp_path
):
    longer = *DAMAGES[:1], LinkShortening("forearm_link", 0.041), *DAMAGES[2:]
    for damages, same in ((DAMAGES, True), (longer, False)):
        path = tmp_path / str(same) / "links_encoders.rrd"
        write_recording(path, job, resolved(damages), learners(job), {}, 0)
        assert rrd("compare", "--unordered", recording[0], path) == same


def test_a_recording_that_differs_from_the_experiment_is_not_written(
    job, resolved, results, tmp_path
):
    spoilt = {name: frame.reset_index(drop=True) for name, frame in results.items()}
    measured = spoilt["ritter"].loc[3, "orientation_error_deg"]
    spoilt["ritter"].loc[3, "orientation_error_deg"] *= 1 + 1e-8
    path = tmp_path / "links_encoders.rrd"
    with pytest.raises(InvalidFile, match="ritter after 24 moves") as caught:
        write_recording(path, job, resolved(DAMAGES), learners(job), spoilt, 0)
    assert f"orientation_error_deg is {measured}" in str(caught.value)
    assert str(spoilt["ritter"].loc[3, "orientation_error_deg"]) in str(caught.value)
    assert not list(tmp_path.iterdir())


def test_missing_meshes_leave_no_recording(job, resolved, tmp_path, monkeypatch):
    monkeypatch.setattr(meshes, "KINDS", ())
    path = tmp_path / "bare.rrd"
    with pytest.raises(InvalidFile, match="mesh 'package:.* is in none of its packages"):
        write_recording(path, job, resolved(DAMAGES), learners(job), {}, 0)
    assert not list(tmp_path.iterdir())


@pytest.fixture
def sample(study, tmp_path):
    """Three searches, of which the first one found the best settings, and the second the worst."""
    trials = pd.DataFrame({"search": [1, 2, 3], "initial_width": [3.8, 0.3, 1.0]})
    finals = {f"{name}/{net}": 0.3 for name in ("position", "orientation") for net in search.NETS}
    trials = trials.assign(
        **finals, initial_rate=0.8, final_rate=0.4, **dict.fromkeys((*ERRORS, "score"), 1)
    )
    path = tmp_path / "improved_40.csv"
    head = sought(study, "improved_40").model_copy(update={"searches": 3})
    path.write_text(sample_of(head, trials))
    return path


def test_the_typical_search_is_recorded_as_the_experiment_measured_it_with_outliers_and_all(
    job, resolved, sample, tmp_path, monkeypatch
):
    disturbed = *DAMAGES, Outliers(0.3, 0.05), Repeatability(0.0003)
    scenario, other = tmp_path / "disturbed.json", tmp_path / "undisturbed.json"
    call.write(scenario, resolved(disturbed))
    call.write(other, resolved(DAMAGES[:-1]))
    job = job.model_copy(update={"learners": {"improved": job.learners["improved"]}})
    history = tmp_path / "improved.parquet"
    columns = campaign.train_seeds(
        scenario,
        sample,
        tmp_path / "improved.npz",
        job.learners["improved"],
        seeds=5,
        first=0,
        last=15,
        measuring=job.measuring,
        throughout=True,
        seed=SEED,
    )
    frame = pd.DataFrame(columns)
    frame.to_parquet(history)
    assert frame.groupby("search")["seed"].unique().map(list).tolist() == [
        [*range(first, first + 5)] for first in (0, 5, 10)
    ]
    assert typical(errors_of(frame)) == 2
    path = tmp_path / "recordings" / "links_encoders.rrd"
    with pytest.raises(InvalidFile, match="improved after 8 moves: position_error_cm is "):
        record(path, job, other, [sample], [history])
    assert not path.exists()
    record(path, job, scenario, [sample], [history])
    assert path.exists()
    written = []
    monkeypatch.setattr(writing, "write_recording", lambda *its: written.append(its[-1]))
    record(path, job, scenario, [sample], [history])
    assert written == [10], "the first seed of the third search"


def test_one_learner_other_than_the_improved_of_an_arm_described_elsewhere(
    job, robot, resolved, tmp_path
):
    folder = robot.urdf.parents[1]
    urdf = tmp_path / "my_arm" / "urdf" / "arm.urdf"
    urdf.parent.mkdir(parents=True)
    package = f"example-robot-data/robots/{folder.name}/"
    urdf.write_text(robot.urdf.read_text().replace(package, "my_arm/"))
    shutil.copytree(folder / "meshes", tmp_path / "my_arm" / "meshes")
    its = resolved(DAMAGES, urdf=str(urdf))
    alone = {"learners": {"ritter": job.learners["ritter"]}, "published": {}}
    job = job.model_copy(update=alone)
    path = tmp_path / "links_encoders.rrd"
    watched = write_recording(path, job, its, learners(job), {}, 0)
    entities = {chunk.entity_path for chunk in RrdReader(path).store().stream().to_chunks()}
    assert "/errors/position_error_cm/ritter" in entities
    assert "/errors/position_error_cm/paper" not in entities
    sight = sight_of(robot.workspace, np.ones((1, 3)))
    assert len(arrange(watched, sight, {}).root_container.contents) == 1
