"""A new kind of damage is one file: studies, plants and recordings know it from there."""

import json
import sys
from pathlib import Path

import pytest

from tests.conftest import run

KINDS = Path(__file__).parent / "kinds"  # as if its files were beside recalib/damaged/damage.py
STUDY = """\
like: quick
scenario: fall
scenarios: {fall: [{link: forearm_link, stretch: 3 cm}]}
experiments: {scenarios: [fall]}
"""
READ = """
import json, sys
import recalib.damaged
recalib.damaged.__path__.append(sys.argv[1])
from pathlib import Path
from replication.recording.captions import in_words
from replication.running.studies import study_of
from replication.scenarios.plants import Resolved
from replication.scenarios.resolving import resolve
study = study_of(Path("."), [Path(sys.argv[2])])
(resolved,), _ = resolve(study, study.robot, ["fall"])
again = Resolved.model_validate_json(resolved.model_dump_json())
assert again == resolved
print(json.dumps({
    "damages": resolved.model_dump(mode="json")["damages"],
    "words": [*map(in_words, resolved.damages)],
    "error_cm": resolved.initial_position_error_cm,
}))
"""


def test_a_study_damages_its_robot_by_a_kind_of_one_file(tmp_path):
    """In a process of its own, which finds the new kind."""
    (mine := tmp_path / "mine.yaml").write_text(STUDY, encoding="utf-8")
    found = json.loads(run(sys.executable, "-c", READ, KINDS, mine, check=True).stdout)
    assert found["damages"] == [{"link": "forearm_link", "stretch": "3 cm"}]
    assert found["words"] == ["forearm: stretch 3 cm"]
    assert found["error_cm"] == pytest.approx(3, abs=1e-6), "the tool misses by what was added"
