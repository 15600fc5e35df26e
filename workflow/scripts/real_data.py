"""Bring one recording of the real arm, from a file or from its public address, and check that it is the one meant."""

import hashlib
import shutil
import sys
import urllib.request
from pathlib import Path

from recalib.storage import whole
from workflow.scripts.job import job

with job(snakemake):
    source = snakemake.params.source
    with whole(snakemake.output[0]) as path:
        if source["file"]:
            shutil.copy(source["file"], path)
        else:
            with urllib.request.urlopen(source["url"]) as reply:
                path.write_bytes(reply.read())
        found = hashlib.sha256(Path(path).read_bytes()).hexdigest()
        if found != source["sha256"]:
            sys.exit(
                f"{source['file'] or source['url']} has SHA-256 {found}; expected {source['sha256']}"
            )
