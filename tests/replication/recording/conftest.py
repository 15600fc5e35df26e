"""A recording of two learners, and what it takes to make another one."""

import numpy as np
import pandas as pd
import pytest
from rerun.chunk import RrdReader

from recalib.damaged.damage import BaseShift, EncoderShift, LinkShortening
from recalib.damaged.disturbances import Noise
from recalib.damaged.nongeometric import Sag
from recalib.learners.hierarchical import HierarchicalLearner
from recalib.learners.rules import IMPROVED, Rules
from recalib.learners.schedules import Schedule
from replication.config.study import Measuring
from replication.recording.phases import CLOCK
from replication.recording.writing import write_recording
from replication.scenarios.plants import resolve
from replication.training.poses import Stream, train_for_results
from replication.training.recordings import Recording
from tests.conftest import changed

SEED, ITERATIONS, TESTS = 7, 40, 30
MEASURE_AT = range(0, ITERATIONS + 1, 4)
DAMAGES = (
    BaseShift(translate=(0.01, 0.0, -0.02)),
    LinkShortening("forearm_link", 0.04),
    EncoderShift("elbow_joint", np.radians(-4)),
    Sag("shoulder_lift_joint", 0.0002),
    Noise(0.0002, 0.0003),
)


def learner(name, runs=1):
    if name == "improved":
        widths = {"position": (0.6, 1.4), "orientation": (0.7, 1.2)}
        return HierarchicalLearner(IMPROVED, Schedule(3.8, widths, 0.8, 0.4), runs=runs)
    rules, widths = Rules(False, False, False, False), {"pose": (0.2, 0.3)}
    return HierarchicalLearner(rules, Schedule(0.5, widths, 0.4, 0.1), runs=runs)


def learners(job):
    return {name: learner(name) for name in job.learners}


@pytest.fixture(scope="session")
def job(study):
    """A recording of two learners."""
    return Recording(
        scenario="links_encoders",
        learners={
            name: study.learners[name].model_copy(update={"iterations": ITERATIONS})
            for name in ("improved", "ritter")
        },
        measuring=Measuring(
            tests=TESTS, measure_every=4, measure_evenly=ITERATIONS, measurements=2
        ),
        seed=SEED,
        published={"position_error_cm": 8.3, "orientation_error_deg": 4.7},
        meshes_sha256="",
    )


@pytest.fixture(scope="session")
def resolved(plan):
    """A scenario of these damages, on the study's robot or one changed."""

    def resolved(damages, **robot):
        nominal = changed(plan.nominal("ur10"), **robot)
        return resolve("links_encoders", nominal, damages, poses=2, seed=SEED)

    return resolved


def poses(runs=1):
    """What is learned from, and what is tested on."""
    return Stream.SCENARIO.draw(SEED, range(runs), ITERATIONS, TESTS, scenario="links_encoders")


@pytest.fixture(scope="session")
def results(job, resolved):
    """What an experiment without a recording measures of the learners in the first of two runs."""
    its, measured = resolved(DAMAGES), {}
    controller = its.controller()
    for name in job.learners:
        plant = its.plant(controller, SEED, range(2))
        history = train_for_results(plant, learner(name, 2), poses(2), MEASURE_AT)
        frame = pd.DataFrame(history.columns())
        measured[name] = frame[frame["run"] == 0]
    return measured


@pytest.fixture(scope="session")
def recording(tmp_path_factory, job, resolved, results):
    """The file, and what was watched."""
    path = tmp_path_factory.mktemp("recordings") / "links_encoders.rrd"
    return path, write_recording(path, job, resolved(DAMAGES), learners(job), results, 0)


@pytest.fixture(scope="session")
def columns(recording):
    """A function that returns a column of an entity: its times, None if static, and its values."""
    batches = [
        (chunk.entity_path, chunk.to_record_batch())
        for chunk in RrdReader(recording[0]).store().stream().to_chunks()
    ]

    def column(entity, component):
        for path, batch in batches:
            names = batch.schema.names
            if path == entity and component in names:
                times = batch.column(CLOCK).to_pylist() if CLOCK in names else None
                return times, batch.column(component).to_pylist()
        raise KeyError((entity, component))

    return column
