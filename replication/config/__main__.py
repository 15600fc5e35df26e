"""Writes the schema of the configuration for editors."""

from recalib.files.storage import whole
from replication.config import schema

with whole(schema.FILE) as path:
    path.write_text(schema.text(), encoding="utf-8")
