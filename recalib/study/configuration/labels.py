"""The factors of the multiverse in words; config.yaml has their reasons."""

from collections.abc import Mapping
from typing import NamedTuple


class Label(NamedTuple):
    """What a factor asks, and by level what completes the sentence."""

    asks: str
    levels: Mapping[str, str]


LABELS: Mapping[str, Label] = {
    "robot": Label(
        "the robot is",
        {
            "ur10": "a UR10",
            "ur5": "a UR5",
            "z1": "a Z1",
            "jaco": "a Jaco",
            "puma560": "a PUMA 560",
        },
    ),
    "home": Label(
        "the workspace lies",
        {"configured": "with a wide margin", "random": "wherever it can"},
    ),
    "assignment": Label(
        "the damage hits",
        {"nearest": "links with the published errors", "any": "any links"},
    ),
    "shortening": Label(
        "a link is shortened along",
        {"line": "the line between its joints", "axis": "its tube"},
    ),
    "coordinates": Label(
        "orientations are given by",
        {"roll_pitch_yaw": "roll, pitch and yaw", "rotation_vector": "rotation vectors"},
    ),
    "norm": Label(
        "distances of poses are in",
        {
            "half_ranges": "half-ranges",
            "metres_radians": "metres and radians",
            "centimetres_degrees": "cm and degrees",
        },
    ),
    "centres": Label(
        "the outermost cells lie",
        {"boxes": "inside the workspace", "faces": "on its faces"},
    ),
    "dimensions": Label(
        "the schedule's n is",
        {"3": "3, as each net has", "6": "6, as the whole mapping has"},
    ),
    "spread": Label(
        "equal visits are spread over",
        {"widths": "widths", "logarithms": "logarithms of widths"},
    ),
    "displacement": Label(
        "the whole robot is moved",
        {"configured": "one way for all", "random": "in random directions"},
    ),
    "rate": Label(
        "Ritter's learning rate falls",
        {"exponential": "exponentially", "linear": "linearly"},
    ),
    "cells": Label(
        "Ritter's net has as many cells as",
        {"each": "one map", "whole": "both maps"},
    ),
    "score": Label(
        "the search minimises",
        {"worse": "the larger error", "geometric_mean": "the mean of both errors"},
    ),
    "effort": Label(
        "the effort of the search is",
        {"full": "full", "rough": "rough"},
    ),
    "ranges": Label(
        "the search's ranges are",
        {"ours": "the project's", "wider": "twice as wide"},
    ),
    "initial": Label(
        "values of theta start as",
        {"identity": "the identity", "random": "random values"},
    ),
    "error": Label(
        "a pose's error is",
        {"norm": "a distance and an angle", "coordinates": "a mean over coordinates"},
    ),
    "widths": Label(
        "equal widths are equal in",
        {"half_ranges": "half-ranges", "centimetres_degrees": "cm and degrees"},
    ),
    "order": Label(
        "training poses are",
        {"random": "drawn at random", "even": "spread evenly"},
    ),
    "tool": Label(
        "the robot holds",
        {"flange": "nothing", "longer": "a tool"},
    ),
}


def level_in_words(factor: str, level: object) -> str:
    """A level of a factor; another study's robots go by their names."""
    return LABELS[factor].levels.get(str(level), str(level))
