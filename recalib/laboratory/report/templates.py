"""Rendering of the templates (Jinja2) in this folder."""

import json
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined

from recalib.spelling import counted, listed

UNITS = (1e3, "mm"), (180 / np.pi, "deg")


def in_units(numbers: np.ndarray | tuple[float, ...], digits: int) -> str:
    """A length [m] and, if given, an angle [rad], as text in mm and deg."""
    pairs = zip(UNITS, numbers, strict=False)
    return ", ".join(f"{scale * number:.{digits}g} {unit}" for (scale, unit), number in pairs)


def quoted(text: str) -> str:
    """The text as a TOML string."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def short(number: float) -> str:
    """The number with two digits, without an exponent: 100, not 1e+02."""
    return f"{float(f'{number:.2g}'):g}"


def render(template: str, **values: Any) -> str:
    """Render a template; in HTML and XML, the values are escaped."""
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
