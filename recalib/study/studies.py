"""Which studies there are: the shipped one, those that change it, and the one of the present call."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from recalib.errors import RecalibError
from recalib.study.configuration.checks import check
from recalib.study.configuration.reading import read_study
from recalib.study.configuration.study import Study
from recalib.study.layout import SHIPPED, root_of

CONFIGURATION = "config.yaml"
OTHERS = "workflow/studies"
LOCK = "workflow/shipped.json"  # digests of the shipped study, part by part; see `make ship`
PLACES = {"real": {"data": {"fit": {"file"}, "test": {"file"}}}}  # where copies of data lie


class NotShipped(RecalibError):
    """A study under the name of the shipped one that differs from it."""

    def __init__(self, changed: Sequence[str]):
        self.changed = list(changed)
        super().__init__(
            f"this is not the shipped study: {', '.join(changed)} changed, and it alone may write"
            f" README, docs and figures; valid: `name: my_study` beside the changes, for results"
            f" in {root_of('my_study')}, or `make ship` to ship it instead"
        )


class NameTaken(RecalibError):
    """Two studies of one name."""


def digests(study: Study) -> dict[str, str]:
    """A digest of each part of a study, without where copies of data lie."""
    parts = json.loads(study.model_dump_json(exclude=PLACES))
    return {
        key: hashlib.sha256(json.dumps(part, sort_keys=True).encode()).hexdigest()[:16]
        for key, part in parts.items()
    }


def check_shipped(study: Study, lock: Mapping[str, str]) -> None:
    """Raise NotShipped where the study is not the one of the lock."""
    now = digests(study)
    if changed := [key for key in now if now[key] != lock.get(key)]:
        raise NotShipped(changed)


def read_studies(
    project: Path, files: Sequence[Path], changes: Mapping
) -> tuple[str, dict[str, Study]]:
    """The folder of results of this call's study, and every study by that of its own.

    Args:
        project: folder of the project.
        files: configuration files of this call, laid over config.yaml one after the other.
        changes: settings of its command line, laid over them.

    Raises InvalidConfiguration, NotShipped, NameTaken.
    """
    base = project / CONFIGURATION
    main = read_study(base, *files, *([changes] if changes else []))
    others = [read_study(base, path) for path in sorted((project / OTHERS).glob("*.yaml"))]
    studies = {root_of(main.name): main}
    if main.name != SHIPPED and (files or changes):
        others.insert(0, read_study(base))
    for study in others:
        if study != studies.setdefault(root_of(study.name), study):
            raise NameTaken(f"two studies are called {study.name!r}; valid: a name of its own")
    if shipped := studies.get(root_of(SHIPPED)):
        check_shipped(shipped, json.loads((project / LOCK).read_text(encoding="utf-8")))
    for study in studies.values():
        check(study)
    return root_of(main.name), studies


def ship(project: Path) -> None:
    """Make config.yaml the shipped study."""
    text = json.dumps(digests(read_study(project / CONFIGURATION)), indent=2) + "\n"
    (project / LOCK).write_text(text, encoding="utf-8")
