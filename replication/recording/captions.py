"""The texts in a recording."""

import importlib.metadata
from typing import Any

from recalib.damaged.damage import EncoderShift, LinkShortening
from replication.config.damages import Entry, damages_among, describe, joint_of, link_of
from replication.recording import colours
from replication.recording.watched import Watched
from replication.scenarios.plants import Resolved
from replication.training.measured import ERRORS

PARTS = "link", "joint", "encoder"  # keys of the damaged part
PACKAGES = "pin", "rerun-sdk", "numpy", "scipy"


def description(resolved: Resolved, watched: Watched) -> str:
    """The text next to the arm, in Markdown."""
    damages = damages_among(resolved.damages)
    disturbances = [entry for entry in resolved.damages if entry not in damages]
    text = [
        f"**The grey arm** is the real one, a {resolved.robot.upper()}; its tool is orange."
        " **The blue skeleton** is the arm that its controller assumes: it is always exactly where"
        " it was sent.",
        f"**Its damage** (yellow): {'; '.join(map(in_words, damages))}."
        if damages
        else "**It has no damage**: it is where its controller assumes it to be.",
    ]
    if disturbances:
        text.append(f"**Disturbances**: {'; '.join(map(in_words, disturbances))}.")
    learned = watched.history
    misses = " and misses them" if damages else ""
    before, after = (_errors(watched)[row] for row in (0, -1))
    text += [
        f"The arm visits {len(watched.desired)} poses (white){misses}, learns for"
        f" {learned.iterations[-1]} iterations ({learned.moves[-1]} moves), and"
        f" visits them again. Mean errors over all test poses: {before} before, {after} after.",
        "**The map** that corrects commands has its own picture. Each blue dot is a cell; those"
        " that have just learned are larger. An arrow shows how far a cell moves a command. Orange"
        " lines lead from desired positions (white) to reached ones.",
    ]
    return "\n\n".join(text)


def in_words(entry: Entry) -> str:
    """A damage or disturbance as text: its part, kind and amount."""
    words = {
        key: ", ".join(value) if isinstance(value, list) else value
        for key, value in describe(entry).items()
        if key not in PARTS
    }
    phrases = [f"{key.replace('_', ' ')} {value}" for key, value in words.items()]
    match entry:
        case LinkShortening():
            phrases[0] = f"{words['shorten']} short"
        case EncoderShift():
            phrases[0] = f"encoder {words['shift']}"
    if part := link_of(entry) or joint_of(entry):
        name = part.removesuffix("_link").removesuffix("_joint").replace("_", " ")
        return f"{name}: {', '.join(phrases)}"
    return ", ".join(phrases)


def legend(resolved: Resolved) -> dict[str, colours.Colour]:
    """The legend of the picture: texts with their colours."""
    lines = {"desired pose": colours.WHITE, "tool": colours.REACHED}
    if damages_among(resolved.damages):
        lines["damage"] = colours.DAMAGE
    return lines | {"assumed arm": colours.NOMINAL}


def _errors(watched: Watched) -> list[str]:
    """Mean errors over all test poses at each measurement."""
    position, orientation = (watched.history.columns()[error] for error in ERRORS)
    pairs = zip(position, orientation, strict=True)
    return [f"{centimetres:.2f} cm and {degrees:.2f}°" for centimetres, degrees in pairs]


def progress(resolved: Resolved, watched: Watched) -> list[str]:
    """The caption at each measurement; the first and last are also shown during visits of poses."""
    stage = "recalibration" if damages_among(resolved.damages) else "learning"
    moments = [f"after {iterations} iterations" for iterations in watched.history.iterations]
    moments[0], moments[-1] = f"before {stage}", f"after {stage}"
    pairs = zip(moments, _errors(watched), strict=True)
    return [f"{words}: mean errors {errors}" for words, errors in pairs]


def properties(resolved: Resolved) -> dict[str, Any]:
    """The recorded scenario, and the versions of packages."""
    versions = {package: importlib.metadata.version(package) for package in PACKAGES}
    return {"scenario": resolved.model_dump_json(), **versions}
