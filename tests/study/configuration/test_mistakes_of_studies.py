"""A mistake in a study of one's own is told in a sentence, of the file that one wrote.

The sentences are those of the function that the workflow calls before anything else.
"""

import pytest
import yaml

from recalib.study.configuration.messages import InvalidConfiguration
from recalib.study.studies import read_studies
from tests.conftest import ROOT
from tests.study.configuration.test_config import says

TABLE = yaml.safe_load((ROOT / "tests" / "mistakes_of_studies.yaml").read_text(encoding="utf-8"))
HOME = ["0 deg", "-45 deg", "0 deg", "-120 deg", "0 deg", "75 deg", "45 deg"]
PANDA = (
    "&panda {urdf: panda.urdf, tool: panda_link8, home: {"
    + ", ".join(f"panda_joint{number}: {angle}" for number, angle in enumerate(HOME, 1))
    + "}, workspace: {position: [20 cm, 24 cm, 20 cm], orientation: [40 deg, 40 deg, 40 deg]},"
    " links: [panda_link2, panda_link3, panda_link4, panda_link6]}"
)


def mistakes_of(row, folder) -> list[str]:
    path = folder / row.get("file", "mine.yaml")
    path.write_text(row["study"].replace("{panda}", PANDA), encoding="utf-8")
    with pytest.raises(InvalidConfiguration) as caught:
        read_studies(ROOT, [path], {})
    return caught.value.mistakes


def test_there_are_sixty_and_more_and_each_says_what_for():
    assert len(TABLE) >= 60 and all(row["why"] for row in TABLE)


@pytest.mark.parametrize("row", TABLE, ids=[row["why"] for row in TABLE])
def test_a_mistake_is_told_of_the_file_that_one_wrote(row, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "workflow").symlink_to(ROOT / "workflow")  # with the URDF of a robot
    sentences = []
    for line in mistakes_of(row, tmp_path):
        source, _, sentence = line.partition(":")
        assert source == row.get("file", "mine.yaml") and "config.yaml" not in sentence
        sentences.append(sentence.strip())
    assert sentences == says(row)
