"""What a recording says about itself, in words."""

import importlib.metadata
import json
from collections.abc import Mapping, Sequence
from typing import Any

from recalib.study.configuration.damages import Entry, damages_among, describe
from recalib.study.entrants import label_of
from recalib.study.measured import ERRORS
from recalib.study.plants import Resolved
from recalib.study.recording.scatter import enlarged
from recalib.study.recording.story import Watched
from recalib.study.recordings import Recording

NOTHING = 1e-3  # cm and degrees: an error below it is none

ARMS = """\
**The grey arm is real**, a {robot}. **The blue skeleton** is the arm that its controller believes \
in, always exactly where it was sent."""
WRONG = """\
**What is wrong** (yellow): {entries}."""
RIGHT = """\
**Nothing is wrong with this arm**: it is where its controller believes."""
DISTURBED = """\
**What disturbs it**: {entries}. Pink: how far {repeated} measurements of each pose are \
off{enlarged}."""
MISSES = """\
It visits {poses} poses (white axes) and misses them (orange: by 10 cm, pale: by 1 mm), learns for \
{moves} moves, and visits them again: mean errors over all test poses are {before} before, {after} \
after."""
KEPT = """\
It visits {poses} poses (white axes), learns for {moves} moves that there is nothing to correct, \
and visits them again: mean errors over all test poses stay below {nothing:g} cm and\
 {nothing:g}°."""
SPOILT = """\
It visits {poses} poses (white axes), learns for {moves} moves although there is nothing to \
correct, and visits them again: mean errors over all test poses are {before} before, {after} \
after."""
MAP = """\
**The map** that corrects its commands: cells (dots) light up about the one that learned last; \
arrows are how far each moves a command."""
MODEL = """\
**What corrects its commands** is a model of the arm, identified from where it went."""
BESIDE = """\
**The same arm under {count} learners**: the same poses in the same order, and one clock of moves \
while they learn. Colours as in the first tab.

{each}"""
EACH = "**{name}**, {what}: {moves} moves, from {before} to {after}."
PACKAGES = "pin", "rerun-sdk", "numpy", "scipy"


def panel(resolved: Resolved, watched: Mapping[str, Watched]) -> str:
    """The text beside the first learner's arm, in Markdown."""
    main = next(iter(watched.values()))
    damaged = damages_among(resolved.damages)
    disturbances = [entry for entry in resolved.damages if entry not in damaged]
    position, orientation = _errors(main)
    kept = max(*position, *orientation) < NOTHING
    story = MISSES if damaged else KEPT if kept else SPOILT
    paragraphs = [
        ARMS.format(robot=resolved.robot.upper()),
        WRONG.format(entries="; ".join(map(in_words, damaged))) if damaged else RIGHT,
        *([_disturbed(disturbances, main)] if disturbances else []),
        story.format(
            poses=len(main.desired), moves=main.history.moves[-1], nothing=NOTHING, **_ends(main)
        ),
        MAP if main.cells else MODEL,
    ]
    return "\n\n".join(paragraphs)


def _disturbed(disturbances: Sequence[Entry], watched: Watched) -> str:
    times = enlarged(watched)
    return DISTURBED.format(
        entries="; ".join(map(in_words, disturbances)),
        repeated=watched.scatter.shape[1],
        enlarged=f", {times} times enlarged" if times > 1 else "",
    )


def beside(watched: Mapping[str, Watched]) -> str:
    """The text below all learners' arms, in Markdown."""
    each = (
        EACH.format(
            name=label_of(name),
            what="a map" if its.cells else "an identified model",
            moves=its.history.moves[-1],
            **_ends(its),
        )
        for name, its in watched.items()
    )
    return BESIDE.format(count=len(watched), each="\n\n".join(each))


def when(resolved: Resolved) -> tuple[str, str]:
    """What the captions call the first and the third act."""
    what = "recalibration" if damages_among(resolved.damages) else "learning"
    return f"before {what}", f"after {what}"


def in_words(entry: Entry) -> str:
    """What is wrong, in the words of the configuration."""
    return _said(describe(entry))


def _errors(watched: Watched) -> tuple[Sequence[float], ...]:
    columns = watched.history.columns()
    return tuple(columns[error] for error in ERRORS)


def _ends(watched: Watched) -> dict[str, str]:
    position, orientation = _errors(watched)
    both = (f"{position[row]:.2f} cm and {orientation[row]:.2f}°" for row in (0, -1))
    return dict(zip(("before", "after"), both, strict=True))


def _said(words: Any) -> str:
    match words:
        case dict():
            return ", ".join(f"{key} {_said(value)}" for key, value in words.items())
        case list():
            return ", ".join(words)
    return str(words)


def properties(job: Recording, resolved: Resolved) -> dict[str, str]:
    """The job that was done, what it was done on, and with which packages."""
    versions = {package: importlib.metadata.version(package) for package in PACKAGES}
    return {
        "robot": resolved.robot,
        "damage": json.dumps([in_words(entry) for entry in resolved.damages]),
        "job": job.model_dump_json(),
        **versions,
    }
