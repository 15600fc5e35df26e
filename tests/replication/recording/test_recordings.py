"""A recording is written whole or not at all, and is that of a training of the study."""

import pandas as pd
import pytest
import rerun as rr

from recalib import InvalidFile, LinkShortening
from replication.recording import check_end, record, typical_seed
from replication.recording.viewer import PROGRAM, quiet
from tests.conftest import changed, run
from tests.replication.recording.conftest import DAMAGES, OWN, trained


def rrd(*command) -> bool:
    return run(PROGRAM, "rrd", *command, env=quiet()).returncode == 0


def test_every_recording_is_valid_and_small(files):
    for path in files.recordings:
        check_end(path)
        assert rrd("verify", path)
        assert path.stat().st_size < 20e6


@pytest.mark.parametrize("share", [0, 0.5, 0.99])
def test_a_recording_that_ends_too_early_is_refused(recording, tmp_path, share):
    content, cut = recording.read_bytes(), tmp_path / "cut.rrd"
    cut.write_bytes(content[: int(share * len(content))])
    with pytest.raises(InvalidFile):
        check_end(cut)


def test_two_recordings_of_the_same_are_equal_and_a_millimetre_shows(small, files, tmp_path):
    longer = [*DAMAGES[:1], LinkShortening("forearm_link", 0.041), *DAMAGES[2:]]
    for damages, same in ((DAMAGES, True), (longer, False)):
        scenarios = small.scenarios | {OWN: damages}
        study = changed(small, experiments={"scenarios": (OWN,)}, scenarios=scenarios)
        (tmp_path / str(same)).mkdir()
        other = trained(study, tmp_path / str(same))
        record(study, *other)
        assert rrd("compare", "--unordered", files.recordings[0], other.recordings[0]) == same


def test_a_recording_that_differs_from_the_history_is_not_written(small, files, tmp_path):
    """By a hundred-millionth, after 24 iterations in the first scenario."""
    table = pd.read_parquet(files.histories[0])
    seed = typical_seed(table)
    row = table.query(f"seed == {seed} and iteration == 24").index[0]
    table.loc[row, "orientation_error_deg"] *= 1 + 1e-8
    spoilt, rrds = tmp_path / "improved.parquet", [tmp_path / "a.rrd", tmp_path / "b.rrd"]
    table.to_parquet(spoilt)
    histories = [spoilt, *files.histories[1:]]
    with pytest.raises(InvalidFile, match="orientation_error_deg differs from that of the"):
        record(small, files.scenarios, files.settings, histories, rrds)
    assert [*tmp_path.iterdir()] == [spoilt]


def test_a_recording_without_its_end_is_not_written(small, files, tmp_path, monkeypatch):
    """As on a full disk: Rerun itself only warns."""
    monkeypatch.setattr(rr.RecordingStream, "disconnect", lambda self: None)
    with pytest.raises(InvalidFile):
        record(small, *files._replace(recordings=[tmp_path / "a.rrd", tmp_path / "b.rrd"]))
    assert not list(tmp_path.iterdir())
