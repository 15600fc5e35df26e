"""Text and pages from templates (Jinja2) in this folder."""

import json
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined

from recalib.spelling import counted, listed

UNITS = (1e3, "mm"), (180 / np.pi, "deg")


def in_units(numbers: np.ndarray | tuple[float, ...], digits: int) -> str:
    """A length [m] and, if there is one, an angle [rad] as people read them."""
    pairs = zip(UNITS, numbers, strict=False)
    return ", ".join(f"{scale * number:.{digits}g} {unit}" for (scale, unit), number in pairs)


def quoted(text: str) -> str:
    """A text as TOML has it."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def short(number: float) -> str:
    """Two digits, and no power of ten where people write none: 100, not 1e+02."""
    return f"{float(f'{number:.2g}'):g}"


def render(template: str, **values: Any) -> str:
    """A template with values in it; in HTML and XML, these are escaped."""
    environment = Environment(
        loader=PackageLoader("recalib.laboratory.report", "."),
        autoescape=lambda name: name is not None and (".html" in name or ".urdf" in name),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.globals["counted"] = counted
    environment.filters |= {
        "mm": lambda length: f"{1e3 * length:.3g} mm",
        "degrees": np.degrees,
        "in_units": in_units,
        "listed": lambda words, last: listed(map(str, words), last),
        "short": short,
        "quoted": quoted,
    }
    return environment.get_template(template).render(values)
