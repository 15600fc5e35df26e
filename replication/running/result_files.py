"""Write the result of a job in the format of the file's suffix, completely or not at all."""

import json
from pathlib import Path
from typing import Any

import pandas as pd

from recalib.files.storage import whole


def write(path: Path, value: Any, digits: int | None = None) -> None:
    """Write a table, a model, plain data, a text or bytes.

    Args:
        digits: significant digits of numbers in a CSV table; all digits if None.
    """
    with whole(path) as temporary:
        match path.suffix, value:
            case ".parquet", _:
                pd.DataFrame(value).to_parquet(temporary, index=False)
            case _, str():
                temporary.write_text(value, encoding="utf-8")
            case _, bytes():
                temporary.write_bytes(value)
            case ".csv", _:
                decimals = f"%.{digits}g" if digits else None
                pd.DataFrame(value).to_csv(temporary, index=False, float_format=decimals)
            case _:
                plain = value.model_dump(mode="json") if hasattr(value, "model_dump") else value
                temporary.write_text(json.dumps(plain, indent=2) + "\n", encoding="utf-8")
