"""What every job finds around it: the project's own modules, one core, the same last digits."""

import os
from pathlib import Path

PROCESSOR = Path("/proc/cpuinfo")


def prepare(project: Path) -> None:
    """Set the variables that jobs inherit."""
    # The project's modules, also where another copy of it is installed, and how a job starts.
    os.environ["PYTHONPATH"] = os.pathsep.join([str(project), str(project / "workflow" / "start")])
    # Without this, the linear algebra of every job starts a thread for each core of the machine.
    os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    # The same last digits on every processor with AVX2: otherwise NumPy and its linear algebra take
    # other loops on newer ones, and a search ends elsewhere where a likelihood is flat.
    if PROCESSOR.exists() and "avx2" in PROCESSOR.read_text(encoding="utf-8"):
        os.environ["NPY_DISABLE_CPU_FEATURES"] = "X86_V4 AVX512_ICL AVX512_SPR"
        os.environ["OPENBLAS_CORETYPE"] = "Haswell"
