"""A small study with recordings of two scenarios, made as the workflow makes them."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
import pytest
from rerun.chunk import RrdReader

from recalib import BaseShift, EncoderShift, LinkShortening, Noise, Sag
from replication.config import Study
from replication.recording import CLOCK, record, recorded_places
from replication.scenarios import Resolved, resolve
from replication.training.train import train
from tests.conftest import changed
from tests.replication.conftest import ALONE

OWN, INTACT = "links_encoders", "intact"
LEARNERS = "improved", "ritter"
ITERATIONS, TESTS = 40, 30
NOISE = Noise(0.0002, 0.0003)
DAMAGES = (
    BaseShift(translate=(0.01, 0.0, -0.02)),
    LinkShortening("forearm_link", 0.04),
    EncoderShift("elbow_joint", np.radians(-4)),
    Sag("shoulder_lift_joint", 0.0002),
    NOISE,
)
WIDTHS = {"position": (0.6, 1.4), "orientation": (0.7, 1.2), "pose": (0.2, 0.3)}


class Files(NamedTuple):
    """What `record` is given, and what it writes."""

    scenarios: list[Path]
    settings: list[Path]
    histories: list[Path]
    recordings: list[Path]


@pytest.fixture(scope="session")
def small(study) -> Study:
    """The shipped study with two short trainings and damages of every kind."""
    learners = dict.fromkeys(LEARNERS, (ITERATIONS,))
    plan = {"scenarios": (OWN, INTACT), "learners": learners} | ALONE
    scenarios, training = study.scenarios | {OWN: DAMAGES}, {"seeds": 3, "tests": TESTS}
    return changed(study, experiments=plan, scenarios=scenarios, training=training)


def trained(study: Study, root: Path) -> Files:
    """Files of trainings of a study below a folder, of which nothing is recorded yet."""
    settings = root / "settings.csv"
    rows = [
        {"setup": 0, "replicate": 0, "variant": name, "iterations": ITERATIONS}
        | {
            f"{part}_{net}": widths[n]
            for part, widths in WIDTHS.items()
            for n, net in ((0, "g_k"), (1, "g_kl"))
        }
        | {"initial_width": 3.8, "initial_rate": 0.8, "final_rate": 0.4}
        for name in LEARNERS
    ]
    pd.DataFrame(rows).to_csv(settings, index=False)
    files = Files([], [settings], [], [])
    places, learners = recorded_places(study), study.experiments.learners
    scenarios, _ = resolve(study, study.robot, [place.scenario for place in places])
    for place, resolved in zip(places, scenarios, strict=True):
        scenario = Path(place.scenario_file(str(root)))
        histories = [Path(place.history_file(str(root), name)) for name in learners]
        for path in (scenario, histories[0]):
            path.parent.mkdir(parents=True, exist_ok=True)
        scenario.write_text(resolved.model_dump_json(), encoding="utf-8")
        learned = [path.with_suffix(".npz") for path in histories]
        train(study, *place, scenario, [settings], histories, learned)
        files.scenarios.append(scenario)
        files.histories.append(Path(place.history_file(str(root), LEARNERS[0])))
        files.recordings.append(root / "recordings" / f"{place.scenario}.rrd")
    files.recordings[0].parent.mkdir()
    return files


@pytest.fixture(scope="session")
def files(small, tmp_path_factory) -> Files:
    """Those of the small study, with its recordings."""
    written = trained(small, tmp_path_factory.mktemp("results"))
    record(small, *written)
    return written


@pytest.fixture(scope="session")
def recording(files) -> Path:
    """That of the study's own scenario."""
    return files.recordings[0]


@pytest.fixture(scope="session")
def resolved(files) -> Resolved:
    """The study's own scenario."""
    return Resolved.read(files.scenarios[0])


@pytest.fixture(scope="session")
def columns(recording):
    """A function that returns a column of an entity: its times, None if static, and its values."""
    return reader(recording)


def reader(recording: Path):
    batches = [
        (chunk.entity_path, chunk.to_record_batch())
        for chunk in RrdReader(recording).store().stream().to_chunks()
        if chunk.is_static or CLOCK in chunk.timeline_names  # others are not shown at its times
    ]

    def column(entity, component):
        for path, batch in batches:
            names = batch.schema.names
            if path == entity and component in names:
                times = batch.column(CLOCK).to_pylist() if CLOCK in names else None
                return times, batch.column(component).to_pylist()
        raise KeyError((entity, component))

    return column
