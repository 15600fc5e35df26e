"""All that recordings show and say, as it is kept in files."""

import json
import re
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

from recalib.damaged.damage import BaseShift, EncoderShift, LinkShortening
from recalib.damaged.disturbances import Noise, Outliers, Repeatability
from recalib.damaged.nongeometric import Backlash, EccentricGear, Sag
from recalib.errors import InvalidFile
from recalib.learners.polynomial import PolynomialLearner
from replication.config.study import Measuring
from replication.training.measured import ERRORS
from replication.recording import captions, naming, pictures
from replication.recording.blueprint import arrange
from replication.recording.measurements import enlarged
from replication.recording.phases import ARM, CLOCK
from replication.recording.sight import sight_of
from replication.recording.writing import _compare, write_recording
from tests.kept import plain
from tests.logged import arranged, logged
from tests.replication.recording.conftest import learner

EVERY = (
    BaseShift((0.013, -0.007, 0.021), (0.04, -0.03, 0.05)),
    LinkShortening("forearm_link", 0.037),
    LinkShortening("wrist_1_link", 0.011, "axis"),
    EncoderShift("elbow_joint", 0.05),
    EncoderShift("wrist_2_joint", np.radians(-3)),
    EccentricGear("elbow_joint", 0.02, 0.4),
    Sag("shoulder_lift_joint", 1.5e-4),
    Backlash("wrist_1_joint", 0.01),
    Noise(0.0003, 0.0004),
    Repeatability(0.0005),
    Outliers(0.1, 0.02),
)
LEAST = EVERY[1:2]


@pytest.fixture(scope="module")
def small(job, study):
    """A recording of few iterations of one of the paper's learners and one of today's."""
    few = study.learners["improved"].model_copy(update={"iterations": 7})
    measuring = Measuring(tests=5, measure_every=3, measure_evenly=10, measurements=2)
    return job.model_copy(
        update={"learners": {"improved": few, "affine": None}, "measuring": measuring}
    )


@pytest.fixture(scope="module")
def written(small, resolved, tmp_path_factory):
    """The file, what was watched, and on what."""
    its = resolved(EVERY)
    learners = {"improved": learner("improved"), "affine": PolynomialLearner(1)}
    path = tmp_path_factory.mktemp("kept") / "kept.rrd"
    return path, write_recording(path, small, its, learners, {}, 3), its


def test_all_that_is_logged_is_as_kept(written, data_regression):
    path, _, _ = written
    found = {key: its for key, its in logged(path).items() if "/__properties" not in key}
    data_regression.check(plain(found))


def test_all_that_is_said_is_as_kept(written, small, data_regression):
    _, watched, its = written
    job = small.model_copy(update={"published": {"position_error_cm": 8.3}})
    said = captions.properties(job, its)
    kept = {
        "about": captions.about(its, watched).splitlines(),
        "beside": captions.beside(watched).splitlines(),
        "progress": [captions.progress(its, one) for one in watched.values()],
        "words": [naming.in_words(entry) for entry in its.damages],
        "damage": [said["robot"], *json.loads(said["damage"])],
        "keys": sorted(said),
        "job": sorted(json.loads(said["job"])),
        "enlarged": [enlarged(one) for one in watched.values()],
    }
    data_regression.check(plain(kept))


def test_the_blueprint_is_as_kept(written, small, robot, data_regression):
    _, watched, _ = written
    main = watched["improved"]
    sight = sight_of(robot.workspace, (main.achieved[0] - main.desired)[:, :3, 3])
    views = [
        arrange(some, sight, published)
        for some, published in (
            (watched, small.published),
            (watched, {}),
            ({"improved": main}, {"position_error_cm": 43.0}),
        )
    ]
    data_regression.check(plain([arranged(its) for its in views]))


def test_the_ends_of_a_recording_are_as_kept(written, data_regression):
    data_regression.check(plain({"ends": pictures.ends(written[0])}))


class StandIn:
    """A viewer that shows the same picture in every frame, and notes what it is asked."""

    def __init__(self):
        self.asked, self._size = [], None

    @contextmanager
    def opened(self, window):
        self._size = window
        self.asked.append(window)
        yield self

    def open(self, path):
        self.asked.append(Path(path).name)

    def get_state(self):
        views = [SimpleNamespace(name=ARM, view_id=17)]
        return SimpleNamespace(loading=False, recordings=[1], views=views)

    def set_time(self, clock, sequence, play_state):
        self.asked.append(f"{clock} {sequence} {play_state}")

    def save_screenshot(self, path, view):
        self.asked.append(f"picture of {view}")
        shade = np.add.outer(np.arange(self._size[1]), np.arange(self._size[0])) % 251
        Image.fromarray(np.stack([shade] * 3, axis=2).astype(np.uint8)).save(path, "png")


def test_pictures_and_films_are_as_kept(written, tmp_path, monkeypatch, data_regression):
    stand_in = StandIn()
    monkeypatch.setattr(pictures, "_client", stand_in.opened)
    monkeypatch.setattr(pictures.time, "sleep", lambda _: None)
    monkeypatch.setattr(pictures, "WINDOW", (300, 200))
    monkeypatch.setattr(pictures, "FILM", (90, 60))
    pictures.before_and_after(written[0], tmp_path / "before.png", tmp_path / "after.png")
    pictures.take_pictures(written[0], {tmp_path / "arm.png": 5}, ARM, (120, 80))
    taken = len(stand_in.asked)
    pictures.take_film(written[0], tmp_path / "film.webp")
    shown = [its for its in stand_in.asked[taken:] if str(its).startswith(CLOCK)]
    sizes = []
    for name in ("before.png", "after.png", "arm.png", "film.webp"):
        with Image.open(tmp_path / name) as image:
            sizes.append([*image.size, getattr(image, "n_frames", 1), image.info.get("loop")])
            darkest = np.asarray(image.convert("L")).astype(float)
            sizes[-1].append(round(darkest[:3].mean()))
    data_regression.check(plain([sizes, stand_in.asked[40:taken], shown]))


def test_why_a_recording_is_broken_is_as_kept(written, tmp_path, data_regression):
    shown, said = written[1]["affine"].history.columns(), {}
    for spoilt in ("moves", *ERRORS):
        measured = {name: its.copy()[1:] for name, its in shown.items()}
        measured[spoilt][1] = measured[spoilt][1] * 2 + 7
        with pytest.raises(InvalidFile) as refused:
            _compare(tmp_path, "affine", shown, measured)
        said[spoilt] = re.sub(r"(\d\.\d{6})\d+", r"\1", refused.value.reason)
    data_regression.check(said)
