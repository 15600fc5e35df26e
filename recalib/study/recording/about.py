"""What a recording says about itself, in words."""

import importlib.metadata
import json
from collections.abc import Mapping

import yaml

from recalib.study import jobs
from recalib.study.configuration.damages import damages_among, describe
from recalib.study.plants import Resolved
from recalib.study.recording.story import Watched

ARMS = """\
**The grey arm is the real one**, a {robot}, and the blue ghost is the arm that its controller \
believes in, which is always exactly where it was sent."""
DAMAGED = """\
**Press play** (space bar): the arm visits {poses} poses (white axes) and misses them by the \
coloured lines (orange: 10 cm, green: 1 mm), it learns for {iterations} iterations, and it visits \
them again.

**Each command is moved to make up for the misses**, as told by a map whose cells (dots) light up \
around the one that learned last and whose corrections grow as violet arrows. Mean errors at all \
test poses: {before} before, {after} after."""
UNDAMAGED = """\
**Press play** (space bar): the arm visits {poses} poses (white axes), it learns for {iterations} \
iterations, and it visits them again. There is nothing to make up for."""
LEARNING = "**The timeline `iteration`** at the bottom left shows the learning alone"
WRONG = "**What is wrong with it:**"
PACKAGES = "pin", "rerun-sdk", "numpy", "scipy"


def panel(resolved: Resolved, watched: Mapping[str, Watched]) -> str:
    """The text panel, in Markdown.

    Args:
        watched: by learner. The arm is moved by the first of them.
    """
    main = next(iter(watched.values()))
    errors = main.history.columns()
    before, after = (
        f"{errors['position_error_cm'][row]:.2f} cm and {errors['orientation_error_deg'][row]:.2f}°"
        for row in (0, -1)
    )
    acts = DAMAGED if damages_among(resolved.damages) else UNDAMAGED
    told = acts.format(
        poses=len(main.desired),
        iterations=main.history.iterations[-1],
        before=before,
        after=after,
    )
    others = ", the second tab compares learners." if len(watched) > 1 else "."
    paragraphs = [ARMS.format(robot=resolved.robot), told, LEARNING + others]
    if resolved.damages:
        paragraphs.append("\n".join([WRONG, "", *(f"- `{each}`" for each in in_words(resolved))]))
    return "\n\n".join(paragraphs)


def in_words(resolved: Resolved) -> list[str]:
    """Everything wrong with the arm, each as in the configuration: link: forearm_link, ..."""
    return [
        yaml.safe_dump(describe(entry), default_flow_style=True, sort_keys=False, width=1000)
        .strip()
        .removeprefix("{")
        .removesuffix("}")
        for entry in resolved.damages
    ]


def properties(job: jobs.Recording, resolved: Resolved) -> dict[str, str]:
    """The job that was done, what it was done on, and with which packages."""
    versions = {package: importlib.metadata.version(package) for package in PACKAGES}
    return {
        "robot": resolved.robot,
        "damage": json.dumps(in_words(resolved)),
        "job": job.model_dump_json(),
        **versions,
    }
