"""What a recording says about itself, in words."""

import importlib.metadata
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from replication.config.damages import damages_among
from replication.recording.measurements import enlarged
from replication.recording.naming import in_words
from replication.recording.watched import Watched
from replication.scenarios.plants import Resolved
from replication.training.competitors import label_of
from replication.training.measured import ERRORS
from replication.training.recordings import Recording

TEXTS = Path("workflow/recording")
PACKAGES = "pin", "rerun-sdk", "numpy", "scipy"


def about(resolved: Resolved, watched: Mapping[str, Watched]) -> str:
    """The text beside the first learner's arm, in Markdown."""
    main, damages = next(iter(watched.values())), damages_among(resolved.damages)
    disturbances = [entry for entry in resolved.damages if entry not in damages]
    said = {
        "robot": resolved.robot.upper(),
        "damages": "; ".join(map(in_words, damages)),
        "disturbances": "; ".join(map(in_words, disturbances)),
        "repeated": main.scatter.shape[1],
        "times": enlarged(main),
        "poses": len(main.desired),
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
    errors, history = _errors(watched), watched.history
    return {
        "iterations": history.iterations[-1],
        "moves": history.moves[-1],
        "map": watched.cells,
        "before": errors[0],
        "after": errors[-1],
    }


def _errors(watched: Watched) -> list[str]:
    """Mean errors over all test poses at each measurement, in words."""
    position, orientation = (watched.history.columns()[error] for error in ERRORS)
    pairs = zip(position, orientation, strict=True)
    return [f"{centimetres:.2f} cm and {degrees:.2f}°" for centimetres, degrees in pairs]


def progress(resolved: Resolved, watched: Watched) -> list[str]:
    """The caption at each measurement: the first and the last one stand while poses are visited."""
    what = "recalibration" if damages_among(resolved.damages) else "learning"
    when = [f"after {done} iterations" for done in watched.history.iterations]
    when[0], when[-1] = f"before {what}", f"after {what}"
    pairs = zip(when, _errors(watched), strict=True)
    return [f"{words}: mean errors {errors}" for words, errors in pairs]


def properties(job: Recording, resolved: Resolved) -> dict[str, Any]:
    """The job that was done, what it was done on, and with which packages."""
    versions = {package: importlib.metadata.version(package) for package in PACKAGES}
    return {
        "robot": resolved.robot,
        "damage": json.dumps([in_words(entry) for entry in resolved.damages]),
        "job": job.model_dump_json(),
        **versions,
    }
