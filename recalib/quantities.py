"""Lengths and angles as one writes them: '4 cm', '-3 deg'."""

import math
import re

from recalib.errors import InvalidQuantity

LENGTHS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
ANGLES = {"deg": math.pi / 180, "rad": 1.0}
COMPLIANCES = {f"{unit}/Nm": radians for unit, radians in ANGLES.items()}
_QUANTITY = re.compile(r"\s*([-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?)\s*([a-zA-Z/]+)\s*")


def _parse(text: str, units: dict[str, float]) -> float:
    match = _QUANTITY.fullmatch(text) if isinstance(text, str) else None
    if match is None or match[2] not in units:
        raise InvalidQuantity(text, units)
    return float(match[1]) * units[match[2]]


def length(text: str) -> float:
    """Metres. Raises InvalidQuantity."""
    return _parse(text, LENGTHS)


def angle(text: str) -> float:
    """Radians. Raises InvalidQuantity."""
    return _parse(text, ANGLES)


def compliance(text: str) -> float:
    """Radians per newton metre. Raises InvalidQuantity."""
    return _parse(text, COMPLIANCES)


def degrees(radians: float) -> float:
    """Degrees, for people."""
    return radians / ANGLES["deg"]
