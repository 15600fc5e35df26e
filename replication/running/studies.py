"""The study of a call of Snakemake: the shipped study, or one with changes.

`python -m replication.running.studies` makes config.yaml the shipped study: `make ship`.
"""

import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import partial, reduce
from pathlib import Path
from typing import Any

from recalib.errors import RecalibError
from recalib.files.storage import digest
from recalib.spelling import listed
from replication.config.messages import InvalidConfiguration, Mistake, unknown, unlike
from replication.config.reading import Check, Source, placed, read_study
from replication.config.shipped import SHIPPED, root_of
from replication.config.study import Study
from replication.config.values import Placed, from_mapping, shown
from replication.judgement.checks import BAND
from replication.running.consistency import check, unused
from replication.running.geometry import check_robots

CONFIGURATION = "config.yaml"
OTHERS = "workflow/studies"
LIKE = "like"  # the key for the name of another study, which this study changes
LOCK = "workflow/shipped.json"  # digests of the shipped study, part by part; see `make ship`
DESCRIPTION = "real", "description"
EXPECTED = ("expected",)
BANDS = ",".join(BAND)  # the header of a table of bands
PLACES = {"real": {"data": {"fit": {"file"}, "test": {"file"}}}}  # paths of copies of data


def digests(study: Study) -> dict[str, str]:
    """A digest of each part of a study, without paths of copies of data."""
    parts = json.loads(study.model_dump_json(exclude=PLACES))
    return {key: digest(json.dumps(part, sort_keys=True).encode()) for key, part in parts.items()}


def study_of(
    project: Path,
    files: Sequence[Path] = (),
    changes: Mapping[str, object] = {},
    asking: bool = True,
) -> Study:
    """The study of a call of Snakemake.

    Args:
        files: configuration files of this call, which override config.yaml in this order.
        changes: settings on the command line, which override the files.
        asking: whether to check the robots, too: not needed for every job on a cluster.

    Raises InvalidConfiguration, and RecalibError if it has the shipped study's name but differs.
    """
    known = sorted((project / OTHERS).glob("*.yaml"))
    stacks = [[*layers_of(source, known)] for source in files]
    parents = [layer for stack in stacks for layer in stack[:-1]]
    base = reduce(Placed.under, parents, placed(project / CONFIGURATION))
    own = [stack[-1] for stack in stacks] + ([from_mapping(_typed(changes))] if changes else [])
    inherited = base.content["scenarios"].content if "scenarios" in base.content else ()
    checks: list[Check] = [check, partial(named_files, project), partial(unused, [*inherited])]
    study = read_study(base, checks=checks)  # report mistakes in the base as such
    lock = json.loads((project / LOCK).read_text(encoding="utf-8"))
    if not own and digests(study) == lock:
        return study  # its robots were checked by `make ship`
    if asking:
        checks.append(check_robots)
    study = read_study(base, *own, checks=checks)
    changed = [key for key, now in digests(study).items() if now != lock.get(key)]
    if study.name == SHIPPED and changed:
        raise RecalibError(
            f"not the shipped study: it differs in {', '.join(changed)}, and only the shipped study"
            f" may write README, docs and figures; try: add `name: my_study` to the changes, for"
            f" results in {root_of('my_study')}, or `make ship` to ship this study instead"
        )
    return study


def layers_of(source: Source, known: Sequence[Path]) -> list[Placed]:
    """The layers that a source adds to config.yaml: first the study that it is `like`, then itself.

    The other study must be among the known files. By default a study that is like another has no
    bands, and the name of its file. Raises InvalidConfiguration.
    """
    layer = placed(source)
    if LIKE not in layer.content:
        return [layer]
    like = layer.content[LIKE]
    valid = {path.stem: path for path in known if path != source}  # no cycles
    match like.plain():
        case str(name) if name in valid:
            other = valid.pop(name)
        case str(name):
            mistake = unknown((LIKE,), name, valid)
            raise InvalidConfiguration([f"{shown(like.place)}: {mistake}"])
        case value:
            mistake = unlike((LIKE,), value, f"one of {listed(valid, 'and')}")
            raise InvalidConfiguration([f"{shown(like.place)}: {mistake}"])
    defaults = {"name": Path(str(layer.place[0])).stem, "expected": None}
    content = {key: value for key, value in layer.content.items() if key != LIKE}
    content = from_mapping(defaults, layer.place[:1]).content | content
    return [*layers_of(other, [*valid.values()]), Placed(content, layer.place)]


def _typed(value: Any) -> Any:
    """Convert text to numbers, true, false and null: Snakemake does not do so inside brackets."""
    match value:
        case Mapping():
            return {key: _typed(entry) for key, entry in value.items()}
        case list() | tuple():
            return [_typed(entry) for entry in value]
        case str():
            with suppress(ValueError):
                parsed = json.loads(value)
                return parsed if parsed is None or isinstance(parsed, int | float) else value
    return value


def named_files(project: Path, study: Study) -> list[Mistake]:
    """Files in a study's configuration that do not exist, or that are not tables of bands."""
    named = {EXPECTED: study.expected, DESCRIPTION: study.real.description}
    named |= {("real", "data", part, "file"): table.file for part, table in study.real.data}
    mistakes = [
        unlike(path, file, "a file that is there" + (path != DESCRIPTION) * ", or null")
        for path, file in named.items()
        if file is not None and not (project / file).is_file()
    ]
    if study.expected and not mistakes:
        with (project / study.expected).open(encoding="utf-8", errors="replace") as bands:
            if bands.readline().strip() != BANDS:
                valid = f"a table with the header {BANDS}"
                mistakes.append(unlike(EXPECTED, study.expected, valid))
    return mistakes


def ship(project: Path) -> None:
    """Make config.yaml the shipped study."""
    study = read_study(project / CONFIGURATION, checks=(check, check_robots))
    (project / LOCK).write_text(json.dumps(digests(study), indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    ship(Path.cwd())
