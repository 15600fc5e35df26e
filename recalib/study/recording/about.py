"""What a recording says about itself, in words."""

import importlib.metadata
import json
from collections.abc import Mapping
from typing import Any

from recalib.study import jobs
from recalib.study.configuration.damages import damages_among, describe
from recalib.study.measured import ERRORS
from recalib.study.plants import Resolved
from recalib.study.recording.story import Watched

ARMS = """\
**The grey arm is the real one**, a {robot}, and the blue ghost is the arm that its controller \
believes in, which is always exactly where it was sent."""
DAMAGED = """\
**Press play** (space bar): the arm visits {poses} poses (white axes) and misses them by the \
coloured lines (orange: 10 cm, green: 1 mm), it learns for {iterations} iterations, and it visits \
them again."""
INTACT = """\
**Press play** (space bar): the arm visits {poses} poses (white axes), it learns for {iterations} \
iterations, and it visits them again."""
WRONG = """\
**What is wrong with it**: {entries}."""
LEARNING = """\
**Each command is corrected** by a map whose cells (dots) light up around the one that learned \
last and whose corrections grow as violet arrows. Mean errors over all test poses: {before} \
before, {after} after."""
TIMELINE = "**Timeline `iteration`**: the learning alone{others}."
PACKAGES = "pin", "rerun-sdk", "numpy", "scipy"


def panel(resolved: Resolved, watched: Mapping[str, Watched]) -> str:
    """The text panel, in Markdown.

    Args:
        watched: by learner. The arm is moved by the first of them.
    """
    main = next(iter(watched.values()))
    position, orientation = (main.history.columns()[error] for error in ERRORS)
    before, after = (f"{position[row]:.2f} cm and {orientation[row]:.2f}°" for row in (0, -1))
    visits = DAMAGED if damages_among(resolved.damages) else INTACT
    others = "; second tab: all learners" if len(watched) > 1 else ""
    paragraphs = [
        ARMS.format(robot=resolved.robot),
        visits.format(poses=len(main.desired), iterations=main.history.iterations[-1]),
        *([WRONG.format(entries="; ".join(in_words(resolved)))] if resolved.damages else []),
        LEARNING.format(before=before, after=after),
        TIMELINE.format(others=others),
    ]
    return "\n\n".join(paragraphs)


def in_words(resolved: Resolved) -> list[str]:
    """Everything wrong with the arm, in the words of the configuration."""
    return [_said(describe(entry)) for entry in resolved.damages]


def _said(words: Any) -> str:
    match words:
        case dict():
            return ", ".join(f"{key} {_said(value)}" for key, value in words.items())
        case list():
            return ", ".join(words)
    return str(words)


def properties(job: jobs.Recording, resolved: Resolved) -> dict[str, str]:
    """The job that was done, what it was done on, and with which packages."""
    versions = {package: importlib.metadata.version(package) for package in PACKAGES}
    return {
        "robot": resolved.robot,
        "damage": json.dumps(in_words(resolved)),
        "job": job.model_dump_json(),
        **versions,
    }
