"""What a recording says of itself."""

import json
from dataclasses import replace

import numpy as np
import pytest

from recalib.damaged.disturbances import Noise
from recalib.study.plan.recordings import Recording
from recalib.study.recording import captions
from recalib.study.recording.phases import POSES
from recalib.study.recording.watched import REPEATED
from tests.study.recording.conftest import ITERATIONS


def test_it_keeps_its_job_its_damage_and_what_made_it(job, columns):
    def said(key):
        return columns("/__properties/run", key)[1][0][0]

    assert Recording.model_validate_json(said("job")) == job
    assert said("robot") == "ur10" and said("numpy") == np.__version__
    assert json.loads(said("damage"))[1] == "forearm: 4 cm short"


def test_its_texts_name_the_robot_what_is_wrong_with_it_and_the_learners(columns):
    _, texts = columns("/about", "TextDocument:text")
    for words in (
        "UR10",
        "forearm: 4 cm short",
        "elbow: encoder -4 deg",
        "translate 1 cm, 0 m, -2 cm",
        "noise position 0.2 mm, orientation 0.0003 rad",
        f"visits {POSES} poses (white axes) and misses them",
        f"learns for {ITERATIONS} iterations ({2 * ITERATIONS} moves), and",
        f"how far {REPEATED} measurements of each pose are off, 100 times enlarged",
    ):
        assert words in texts[0][0]
    _, texts = columns("/beside", "TextDocument:text")
    assert (
        "under 2 learners" in texts[0][0]
        and "**Ritter**, a map: 40 iterations (80 moves)" in texts[0][0]
    )


@pytest.mark.parametrize("damages", [(), (Noise(0.0002, 0.0003),)], ids=["intact", "noise alone"])
def test_of_an_undamaged_arm_it_speaks_of_no_damage_and_no_misses(resolved, recording, damages):
    its, learned = resolved(damages), recording[1]["improved"]
    panel = captions.about(its, {"improved": learned})
    assert "Nothing is wrong" in panel and "damage" not in panel and "miss" not in panel
    assert "although there is nothing to correct" in panel and ("noise" in panel) == bool(damages)
    first, *_, last = captions.progress(its, learned)
    assert first.startswith("before learning: ") and last.startswith("after learning: ")
    history = learned.history
    nothing = replace(history, position=0 * history.position, orientation=0 * history.orientation)
    panel = captions.about(its, {"improved": replace(learned, history=nothing)})
    assert "that there is nothing to correct" in panel and "stay below 0.001 cm and 0.001°" in panel
    for once in ("position", "orientation"):  # one of both errors, at one measurement
        risen = getattr(nothing, once).copy()
        risen[..., 1, 0] = 0.1
        panel = captions.about(
            its, {"improved": replace(learned, history=replace(nothing, **{once: risen}))}
        )
        assert "although there is nothing to correct" in panel


def test_every_caption_has_the_mean_errors_of_the_panel(columns):
    iterations, ((first,), *learning, (last,)) = columns(
        "/improved/target/caption", "Points3D:labels"
    )
    _, ((text,),) = columns("/about", "TextDocument:text")
    before, after = (caption.partition(": mean errors ") for caption in (first, last))
    assert before[0] == "before recalibration" and after[0] == "after recalibration"
    assert f"are {before[2]} before, {after[2]} after" in text
    assert learning[0] == [first] and learning[-1] == [last]
    for done, (caption,) in list(zip(iterations[1:-1], learning, strict=True))[1:-1]:
        assert caption.startswith(f"after {done} iterations: mean errors ")
