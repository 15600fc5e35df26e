"""What a recording says about itself, in words."""

import importlib.metadata
import json
from collections.abc import Mapping, Sequence
from typing import Any

from recalib.study.competitors import label_of
from recalib.study.configuration.damages import Entry, damages_among, describe
from recalib.study.measured import ERRORS
from recalib.study.plants import Resolved
from recalib.study.recording.landings import enlarged
from recalib.study.recording.watched import Watched
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
VISITS = """\
It visits {poses} poses (white axes){misses}, learns for {moves} moves{what}, and visits them \
again: mean errors over all test poses {errors}."""
MISSES = " and misses them (orange: by 10 cm, pale: by 1 mm)"
ERRORS_MOVE = "are {before} before, {after} after"
ERRORS_STAY = f"stay below {NOTHING:g} cm and {NOTHING:g}°"
MAP = """\
**The map** that corrects its commands: cells (dots) light up about the one that learned last; \
arrows are how far each moves a command."""
MODEL = """\
**What corrects its commands** is a model of the arm, identified from where it went."""
BESIDE = """\
**The same arm under {count} learners**: the same poses in the same order, and one clock of moves \
while they learn. Colours as in the first tab.

{learners}"""
LEARNER = "**{name}**, {what}: {moves} moves, from {before} to {after}."
PACKAGES = "pin", "rerun-sdk", "numpy", "scipy"


def panel(resolved: Resolved, watched: Mapping[str, Watched]) -> str:
    """The text beside the first learner's arm, in Markdown."""
    main = next(iter(watched.values()))
    damaged = damages_among(resolved.damages)
    disturbances = [entry for entry in resolved.damages if entry not in damaged]
    paragraphs = [
        ARMS.format(robot=resolved.robot.upper()),
        WRONG.format(entries="; ".join(map(in_words, damaged))) if damaged else RIGHT,
        *([_disturbed(disturbances, main)] if disturbances else []),
        _story(main, bool(damaged)),
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


def _story(watched: Watched, damaged: bool) -> str:
    columns = watched.history.columns()
    stay = not damaged and max(max(columns[error]) for error in ERRORS) < NOTHING
    what = " that there is nothing to correct" if stay else " although there is nothing to correct"
    return VISITS.format(
        poses=len(watched.desired),
        moves=watched.history.moves[-1],
        misses=MISSES if damaged else "",
        what="" if damaged else what,
        errors=ERRORS_STAY if stay else ERRORS_MOVE.format(**_ends(watched)),
    )


def beside(watched: Mapping[str, Watched]) -> str:
    """The text below all learners' arms, in Markdown."""
    learners = (
        LEARNER.format(
            name=label_of(name),
            what="a map" if its.cells else "an identified model",
            moves=its.history.moves[-1],
            **_ends(its),
        )
        for name, its in watched.items()
    )
    return BESIDE.format(count=len(watched), learners="\n\n".join(learners))


def when(resolved: Resolved) -> tuple[str, str]:
    """What the captions call the first and the third phase."""
    what = "recalibration" if damages_among(resolved.damages) else "learning"
    return f"before {what}", f"after {what}"


def _ends(watched: Watched) -> dict[str, str]:
    position, orientation = (watched.history.columns()[error] for error in ERRORS)
    both = (f"{position[row]:.2f} cm and {orientation[row]:.2f}°" for row in (0, -1))
    return dict(zip(("before", "after"), both, strict=True))


def in_words(entry: Entry) -> str:
    """What is wrong, in the words of the configuration."""
    return _joined(describe(entry))


def _joined(words: Any) -> str:
    match words:
        case dict():
            return ", ".join(f"{key} {_joined(value)}" for key, value in words.items())
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
