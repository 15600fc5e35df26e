"""The environment of every job: the project's own modules, one core, reproducible digits."""

import os
from pathlib import Path

PROCESSOR = Path("/proc/cpuinfo")


def prepare(project: Path) -> None:
    """Set the environment variables that jobs inherit."""
    # The project's own modules, even if another copy is installed, and the jobs' sitecustomize.
    os.environ["PYTHONPATH"] = os.pathsep.join([str(project), str(project / "workflow" / "start")])
    # Without this, the linear algebra of every job starts a thread for each core of the machine.
    os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    # The same last digits on every processor with AVX2. On newer processors NumPy and its linear
    # algebra would use other loops, and a search would end elsewhere on a flat likelihood.
    if PROCESSOR.exists() and "avx2" in PROCESSOR.read_text(encoding="utf-8"):
        os.environ["NPY_DISABLE_CPU_FEATURES"] = "X86_V4 AVX512_ICL AVX512_SPR"
        os.environ["OPENBLAS_CORETYPE"] = "Haswell"
