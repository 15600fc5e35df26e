"""Values that are kept in files of JSON."""

import json
from pathlib import Path
from typing import Self

from recalib.study.configuration.part import Frozen


class Kept(Frozen):
    """A typed value that a file keeps."""

    @classmethod
    def read(cls, path: str | Path) -> Self:
        """The value in a file."""
        return cls.model_validate_json(Path(path).read_bytes())

    def write(self, path: str | Path) -> None:
        """Write the file."""
        text = json.dumps(self.model_dump(mode="json"), indent=2) + "\n"
        Path(path).write_text(text, encoding="utf-8")
