"""What a recording says about itself, in words."""

import importlib.metadata
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from recalib.study.configuration.damages import Entry, damages_among, describe
from recalib.study.inference.measured import ERRORS
from recalib.study.plan.competitors import label_of
from recalib.study.plan.recordings import Recording
from recalib.study.recording.measurements import enlarged
from recalib.study.recording.watched import Watched
from recalib.study.scenarios.plants import Resolved

TEXTS = Path("workflow/recording")
NOTHING = 1e-3  # cm and degrees: an error below it is none
PACKAGES = "pin", "rerun-sdk", "numpy", "scipy"


def about(resolved: Resolved, watched: Mapping[str, Watched]) -> str:
    """The text beside the first learner's arm, in Markdown."""
    main, damages = next(iter(watched.values())), damages_among(resolved.damages)
    disturbances = [entry for entry in resolved.damages if entry not in damages]
    columns = main.history.columns()
    said = {
        "robot": resolved.robot.upper(),
        "damages": "; ".join(map(in_words, damages)),
        "disturbances": "; ".join(map(in_words, disturbances)),
        "repeated": main.scatter.shape[1],
        "times": enlarged(main),
        "poses": len(main.desired),
        "stay": not damages and max(max(columns[error]) for error in ERRORS) < NOTHING,
        "nothing": f"{NOTHING:g}",
        "its": _told(main),
    }
    return _rendered("about", said)


def beside(watched: Mapping[str, Watched]) -> str:
    """The text below all learners' arms, in Markdown."""
    learners = {label_of(name): _told(its) for name, its in watched.items()}
    return _rendered("beside", {"learners": learners})


def _rendered(name: str, said: Mapping[str, Any]) -> str:
    import jinja2

    text = (TEXTS / f"{name}.md.j2").read_text(encoding="utf-8")
    return jinja2.Template(text, undefined=jinja2.StrictUndefined).render(said).strip()


def _told(watched: Watched) -> dict[str, Any]:
    """What is said of a learner."""
    position, orientation = (watched.history.columns()[error] for error in ERRORS)
    before, after = (f"{position[row]:.2f} cm and {orientation[row]:.2f}°" for row in (0, -1))
    moves = watched.history.moves[-1]
    return {"moves": moves, "map": watched.cells, "before": before, "after": after}


def when(resolved: Resolved) -> tuple[str, str]:
    """What the captions call the first and the third phase."""
    what = "recalibration" if damages_among(resolved.damages) else "learning"
    return f"before {what}", f"after {what}"


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
