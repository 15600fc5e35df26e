"""Which studies there are: the shipped one, those that change it, and that of the present call.

`python -m recalib.study.studies` makes config.yaml, as it now is, the shipped one: `make ship`.
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
from recalib.study.checks.consistency import check, unused
from recalib.study.configuration.messages import InvalidConfiguration, Mistake, unknown, unlike
from recalib.study.configuration.reading import Check, Source, placed, read_study
from recalib.study.configuration.shipped import SHIPPED, root_of
from recalib.study.configuration.study import Study
from recalib.study.configuration.values import Placed, from_mapping, shown
from recalib.study.plan.trainings import Trainings

CONFIGURATION = "config.yaml"
OTHERS = "workflow/studies"
LIKE = "like"  # the key by which a study names another one, of which it says what it changes
LOCK = "workflow/shipped.json"  # digests of the shipped study, part by part; see `make ship`
DESCRIPTION = "real", "description"
EXPECTED = ("expected",)
BANDS = "scenario,learner,error,low,high"  # the header of a table of them
PLACES = {"real": {"data": {"fit": {"file"}, "test": {"file"}}}}  # where copies of data lie


def digests(study: Study) -> dict[str, str]:
    """A digest of each part of a study, without where copies of data lie."""
    parts = json.loads(study.model_dump_json(exclude=PLACES))
    return {key: digest(json.dumps(part, sort_keys=True).encode()) for key, part in parts.items()}


def check_shipped(study: Study, lock: Mapping[str, str]) -> None:
    """Raise RecalibError where the study, called as the shipped one, is not the one of the lock."""
    now = digests(study)
    if changed := [key for key in now if now[key] != lock.get(key)]:
        raise RecalibError(
            f"not the shipped study: it differs in {', '.join(changed)}, and the shipped one alone"
            f" may write README, docs and figures; try: `name: my_study` beside the changes, for"
            f" results in {root_of('my_study')}, or `make ship` to ship this one instead"
        )


def read_studies(
    project: Path, files: Sequence[Path], changes: Mapping, asking: bool = True
) -> tuple[str, dict[str, Study]]:
    """The folder of results of this call's study, and every study by that of its own.

    Robots are asked of the scenarios that this call's study trains on; of others, `ask_robots` may.

    Args:
        files: configuration files of this call, laid over config.yaml one after the other.
        changes: settings of its command line, laid over them.
        asking: whether to ask the robots: they need not be asked for every job of a cluster.

    Raises InvalidConfiguration; RecalibError: another study than the shipped one is called as it
    is, or two studies alike.
    """
    known = sorted((project / OTHERS).glob("*.yaml"))

    def read(*sources: Source, checks: Sequence[Check] = ()) -> Study:
        layers = [[*layers_of(source, known)] for source in sources]
        begun = [layer for its in layers for layer in its[:-1]]
        base = reduce(Placed.under, begun, placed(project / CONFIGURATION))
        inherited = base.content["scenarios"].content if "scenarios" in base.content else ()
        further = partial(named_files, project), partial(unused, [*inherited])
        return read_study(base, *(its[-1] for its in layers), checks=(check, *further, *checks))

    own = [*files, *([_typed(changes)] if changes else [])]
    base = read()  # a mistake in it is none in what is laid over it
    trained = [lambda study: ask_robots(study, Trainings(study).scenarios())]
    main = read(*own, checks=trained if asking else ())
    others = list(map(read, known))
    studies = {root_of(main.name): main}
    if main.name != SHIPPED and own:
        others.insert(0, base)
    for study in others:
        if study != studies.setdefault(root_of(study.name), study):
            raise RecalibError(f"two studies are called {study.name!r}; try: a name of its own")
    if shipped := studies.get(root_of(SHIPPED)):
        check_shipped(shipped, json.loads((project / LOCK).read_text(encoding="utf-8")))
    return root_of(main.name), studies


def layers_of(source: Source, known: Sequence[Path]) -> list[Placed]:
    """What a source lays over config.yaml: first the study that it is `like`, then what it says.

    A study that is like another one has no bands, and is called like its file, unless it says so.

    Args:
        known: files of the studies that another one may be like.

    Raises InvalidConfiguration.
    """
    its = placed(source)
    if LIKE not in its.content:
        return [its]
    like = its.content[LIKE]
    valid = {path.stem: path for path in known if path != source}  # it goes round in no circle
    match like.plain():
        case str(name) if name in valid:
            other = valid.pop(name)
        case str(name):
            raise _refused(like, unknown((LIKE,), name, valid))
        case stood:
            raise _refused(like, unlike((LIKE,), stood, f"one of {listed(valid, 'and')}"))
    own = {"name": Path(str(its.place[0])).stem, "expected": None}
    said = {key: value for key, value in its.content.items() if key != LIKE}
    return [
        *layers_of(other, [*valid.values()]),
        from_mapping(own, its.place[:1]),
        Placed(said, its.place),
    ]


def _refused(value: Placed, mistake: Mistake) -> InvalidConfiguration:
    return InvalidConfiguration([f"{shown(value.place)}: {mistake}"])


def _typed(value: Any) -> Any:
    """Numbers, true, false and null as such: inside of brackets the command line has text only."""
    match value:
        case Mapping():
            return {key: _typed(item) for key, item in value.items()}
        case list() | tuple():
            return [_typed(item) for item in value]
        case str():
            with suppress(ValueError):
                meant = json.loads(value)
                return meant if meant is None or isinstance(meant, int | float) else value
    return value


def named_files(project: Path, study: Study) -> list[Mistake]:
    """Files that a study names and that are not there, or are no bands."""
    named = {EXPECTED: study.expected, DESCRIPTION: study.real.description}
    named |= {("real", "data", part, "file"): its.file for part, its in study.real.data}
    found = [
        unlike(path, file, "a file that is there" + (path != DESCRIPTION) * ", or null")
        for path, file in named.items()
        if file is not None and not (project / file).is_file()
    ]
    if study.expected and not found:
        with (project / study.expected).open(encoding="utf-8", errors="replace") as bands:
            if bands.readline().strip() != BANDS:
                found.append(unlike(EXPECTED, study.expected, f"a table with the header {BANDS}"))
    return found


def ask_robots(study: Study, scenarios: Sequence[str]) -> list[Mistake]:
    """What the robots say of these scenarios; see `check_robots`."""
    from recalib.study.checks.geometry import check_robots  # it takes half a second

    return check_robots(study, scenarios)


def ship(project: Path) -> None:
    """Make config.yaml the shipped study."""
    text = (
        json.dumps(digests(read_study(project / CONFIGURATION, checks=(check,))), indent=2) + "\n"
    )
    (project / LOCK).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    ship(Path.cwd())
