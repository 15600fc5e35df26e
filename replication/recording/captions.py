"""What a recording says about itself, in words."""

import importlib.metadata
from collections.abc import Mapping
from typing import Any

from replication.config.damages import damages_among, disturbances_among
from replication.recording import colours
from replication.recording.measurements import enlarged
from replication.recording.naming import in_words
from replication.recording.watched import Watched
from replication.scenarios.plants import Resolved
from replication.training.competitors import label_of
from replication.training.measured import ERRORS

PACKAGES = "pin", "rerun-sdk", "numpy", "scipy"


def about(resolved: Resolved, watched: Mapping[str, Watched]) -> str:
    """The text next to the first learner's arm, in Markdown."""
    main, damages = next(iter(watched.values())), damages_among(resolved.damages)
    disturbances = [entry for entry in resolved.damages if entry not in damages]
    text = [
        f"**The grey arm** is the real one, a {resolved.robot.upper()}. **The blue skeleton** is"
        " the arm that its controller assumes: it is always exactly where it was sent.",
        f"**Its damage** (yellow): {'; '.join(map(in_words, damages))}."
        if damages
        else "**It has no damage**: it is where its controller assumes it to be.",
    ]
    if disturbances:
        times = f", {enlarged(main)} times enlarged" if enlarged(main) > 1 else ""
        text.append(
            f"**Disturbances**: {'; '.join(map(in_words, disturbances))}. Pink lines lead from each"
            f" pose reached to {main.scatter.shape[1]} measurements of it{times}."
        )
    misses = " and misses them (orange)" if damages else ""
    before, after = (_errors(main)[row] for row in (0, -1))
    text += [
        f"The arm visits {len(main.desired)} poses (white){misses}, learns for {_effort(main)}, and"
        f" visits them again. Mean errors over all test poses: {before} before, {after} after.",
        "**The map** that corrects commands: each dot is a cell; those that have just learned are"
        " larger. An arrow shows how far a cell moves a command.",
    ]
    return "\n\n".join(text)


def legend(resolved: Resolved) -> dict[str, colours.Colour]:
    """What stands for what in the picture, with its colour."""
    lines = {"desired pose": colours.WHITE, "pose reached": colours.REACHED}
    if disturbances_among(resolved.damages):
        lines["measurement"] = colours.MEASURED
    if damages_among(resolved.damages):
        lines["damage"] = colours.DAMAGE
    return lines | {"assumed arm": colours.NOMINAL}


def beside(watched: Mapping[str, Watched]) -> str:
    """The text below all learners' arms, in Markdown."""
    text = ["**The same arm with each learner**: the same poses in the same order."]
    for name, its in watched.items():
        errors, kind = _errors(its), "maps" if its.cells else "an identified model"
        text.append(
            f"**{label_of(name)}** ({kind}) learns for {_effort(its)}. Mean errors: {errors[0]}"
            f" before, {errors[-1]} after."
        )
    return "\n\n".join(text)


def _effort(watched: Watched) -> str:
    """How long a learner learns."""
    history = watched.history
    return f"{history.iterations[-1]} iterations ({history.moves[-1]} moves)"


def _errors(watched: Watched) -> list[str]:
    """Mean errors over all test poses at each measurement."""
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


def properties(resolved: Resolved) -> dict[str, Any]:
    """The scenario that was recorded, and with which packages."""
    versions = {package: importlib.metadata.version(package) for package in PACKAGES}
    return {"scenario": resolved.model_dump_json(), **versions}
