"""Our calibration compared with public ones, each in its own environment: make peers.

All get the same rows to learn from and are judged on the same others. The errors are written to
results/peers/errors.csv, and shown in docs/peers.md.

    python -m tests.peers --draws 10 --recording FOLDER
"""

import argparse
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd

from tests.peers.ours import predict_all
from tests.peers.page import PAGE, render
from tests.peers.tasks import Task, tasks

HERE, KEPT = Path(__file__).parent, Path(__file__).parents[2] / "results" / "peers"
PEERS = {"figaroh": "1.0.2", "robotkinecal": "0.1.0"}


def python_of(peer: str) -> Path:
    """The Python of an environment in which the peer is installed, made if need be."""
    package = f"{peer}=={PEERS[peer]}"
    folder = KEPT / package
    python, installed = folder / "bin" / "python", folder / "installed"
    if not installed.exists():
        print(f"installing {package}", flush=True)
        subprocess.run([sys.executable, "-m", "venv", "--clear", folder], check=True)
        quiet = ["--quiet", "--disable-pip-version-check"]
        subprocess.run([python, "-m", "pip", "install", *quiet, package], check=True)
        installed.touch()
    return python


def predictions_of(peer: str, task_files: Path) -> Path:
    """The folder of a peer's predictions, a file for each task; its log lies next to it."""
    folder, script = KEPT / f"by_{peer}", HERE / f"by_{peer}.py"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    print(f"calibrating with {peer}", flush=True)
    with (KEPT / f"{peer}.log").open("w", encoding="utf-8") as log:
        command = [python_of(peer), "-I", script, task_files, folder]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=log)
    return folder


def errors_of(task: Task, predictions: dict[str, np.ndarray]) -> list[dict]:
    """A row for each method; without an error if the method failed."""
    return [
        {
            "scenario": task.scenario,
            "draw": task.draw,
            "who": who,
            "error_mm": 1e3 * task.error(positions) if len(positions) else np.nan,
        }
        for who, positions in predictions.items()
    ]


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m tests.peers", description=__doc__)
    parser.add_argument("--draws", type=int, default=10, help="of each simulated arm")
    parser.add_argument("--recording", type=Path, help="folder of the real UR5's two tables")
    options = parser.parse_args()
    task_files = KEPT / "tasks"
    shutil.rmtree(task_files, ignore_errors=True)
    task_files.mkdir(parents=True)
    all_tasks = list(tasks(options.draws, options.recording))
    for task in all_tasks:
        task.write(task_files)
    folders = [predictions_of(peer, task_files) for peer in PEERS]
    print("calibrating ourselves", flush=True)
    rows = []
    for task in all_tasks:
        rows += errors_of(task, predict_all(task))
        for folder in folders:
            with np.load(folder / f"{task.name}.npz") as predictions:
                rows += errors_of(task, dict(predictions))
    errors = pd.DataFrame(rows)
    errors.to_csv(KEPT / "errors.csv", index=False)
    PAGE.write_text(render(errors, PEERS), encoding="utf-8")


if __name__ == "__main__":
    main()
