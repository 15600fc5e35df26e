"""A new kind of damage is one file: studies, messages, plants and recordings know it from there."""

import json
import subprocess
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
from recalib.errors import RecalibError
from replication.recording.captions import in_words
from replication.running.studies import study_of
from replication.scenarios.plants import Resolved
from replication.scenarios.resolving import resolve
try:
    study = study_of(Path("."), [Path(sys.argv[2])])
except RecalibError as error:
    sys.exit(str(error))
(resolved,), _ = resolve(study, study.robot, ["fall"])
again = Resolved.model_validate_json(resolved.model_dump_json())
assert again == resolved
print(json.dumps({
    "damages": resolved.model_dump(mode="json")["damages"],
    "words": [*map(in_words, resolved.damages)],
    "error_cm": resolved.initial_position_error_cm,
}))
"""


def read(study: Path) -> subprocess.CompletedProcess:
    """What a process of its own, which finds the new kind, reads of a study."""
    return run(sys.executable, "-c", READ, KINDS, study)


@pytest.fixture
def mine(tmp_path) -> Path:
    (tmp_path / "mine.yaml").write_text(STUDY, encoding="utf-8")
    return tmp_path / "mine.yaml"


def test_a_study_damages_its_robot_by_a_kind_of_one_file(mine):
    found = json.loads(read(mine).stdout)
    assert found["damages"] == [{"link": "forearm_link", "stretch": "3 cm"}]
    assert found["words"] == ["forearm: stretch 3 cm"]
    assert found["error_cm"] == pytest.approx(3, abs=1e-6), "the tool misses by what was added"


def test_mistakes_in_it_are_told_as_in_any_other_kind(mine):
    wrong = "[{link: a, stretch: 3}, {link: a, strech: 3 cm}, {link: a}]"
    mine.write_text(STUDY.replace("[{link: forearm_link, stretch: 3 cm}]", wrong), encoding="utf-8")
    amount, key, kind = read(mine).stderr.splitlines()
    assert amount.endswith(
        "fall[0].stretch is 3; expected: a length from 0 to 100 m, such as '0.2 mm' (mm, cm, m)"
    )
    assert key.endswith("unknown key; expected: link or stretch; did you mean stretch?")
    assert "one of {link, " in kind and "{link, stretch}" in kind
