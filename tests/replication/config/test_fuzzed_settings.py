"""Whatever stands in config.yaml is refused in a sentence before any work starts, or makes sense.

Every part of the configuration is replaced by values that people mistype and machines invent. What
is accepted must give a study all of whose jobs can be made.
"""

import json
import math
import re
from collections.abc import Iterator
from functools import partial

import numpy as np
import pytest

from replication.running.checks.consistency import check
from replication.running.checks.geometry import check_robots
from replication.config.messages import InvalidConfiguration
from replication.config.reading import read_study
from replication.config.shipped import root_of
from replication.config.study import Study
from replication.config.values import from_file
from replication.judgement.claims import judging
from replication.judgement.needs import Request
from replication.plots.registry import drawn
from replication.running.studies import named_files
from replication.training.chunks import bounds, chunks, searches_per_job
from replication.training.competitors import MOVES, peers
from replication.training.search import draw
from replication.training.settings import rules_of
from replication.training.trainings import Trainings, searches, seeds
from replication.training.trainings import rules as rules_named
from tests.conftest import ROOT
from tests.rules import Rules

pytestmark = pytest.mark.slow  # thousands of settings take a minute

SHIPPED = ROOT / "config.yaml"
TREE = from_file(SHIPPED).plain()
WRONG = None, True, "", "nonsense", [], [[]], {"a": 1}
NUMBERS = (math.nan, math.inf, -math.inf, 10**6, 10**18, 1e300, 1e-300, 0, -1, 1, 1.5, 1996.0, [1])
TEXTS = ("../../up", "$(reboot)", "; rm x", "a\n", "é", "%s{}", "x" * 999, 3, math.nan)
QUANTITIES = ("0 cm", "0 deg", "-4 cm", "4", "4 inch", "nan cm", "inf deg", "1e400 m", "1e9 deg")
FEW = {"robot", "scenario", "settings"}  # words: none of these values is another one
NAMED = "robots", "scenarios", "home"  # mappings whose keys are names
REFUSAL = re.compile(
    r"(the command line|config\.yaml:\d+:\d+): [a-z]\S*"
    r"(: (unknown|no valid) \w+; .+|: a name with another meaning; try: a new one"
    r"| (is|has|lacks|moves) .+; ((valid|expected): .+|did you mean [\w.]+\?)"
    r"|: .+ again; expected: once| is missing: .+| lacks [\w, ]+| does not fit: .+)",
    re.DOTALL,
)


def parts(tree, path=(), kind=()):
    """The path of every part, and its kind: the same for all robots and for a list's entries."""
    yield path, kind
    if isinstance(tree, dict):
        for key, value in tree.items():
            its = "each" if path and path[-1] in NAMED else key
            yield from parts(value, (*path, key), (*kind, its))
    elif isinstance(tree, list):
        for index, value in enumerate(tree):
            yield from parts(value, (*path, index), (*kind, "each"))


def others(value):
    """What might stand in the place of a value."""
    yield from WRONG
    match value:
        case bool():
            yield from (not value, 1, "yes", math.nan)
        case int() | float():
            yield from (*NUMBERS, float(value), -value, value + 1, 10 * value, str(value))
        case str() if re.match(r"-?[\d.]+ \w", value):
            yield from (*QUANTITIES, f"-{value}", f"1000{value}", f"{value} {value}")
        case str():
            yield from (*TEXTS, value.upper(), f"{value}_2", f"{value}-ur5", f"{value}_200")
        case list():
            yield from (value * 2, value[:1], value[::-1], [*value, *value[:1]], value * 500)
            yield from ([*value, None], [*value, math.nan], {"0": value}, value[:1] * 3)
        case dict():
            some = next(iter(value.values()))
            yield from ({"a/b": some}, {"$(reboot)": some}, {"twin": some}, {"": some}, [some])


def settings(key):
    """Paths below a key of the configuration, each with something else to stand there."""
    known = set()
    for path, kind in parts(TREE[key], (key,), (key,)):
        if kind not in known:
            known.add(kind)
            value = at(TREE, path)
            told = {repr(value): None} | {repr(other): other for other in others(value)}
            yield from ((path, other) for other in [*told.values()][1:])


def at(tree, path):
    for part in path:
        tree = tree[part]
    return tree


def overlay(path, value):
    """The mapping that sets a part to a value: lists are laid over as a whole."""
    *parents, last = path
    above = at(TREE, parents)
    if isinstance(above, list):
        return overlay(parents, [*above[:last], value, *above[last + 1 :]])
    return overlay(parents, {last: value}) if parents else {last: value}


OF_ROBOTS = {"robots", "controller", "paper_damage", "scenarios", "universes"}


class Robots:
    """What the robots say, asked once for all studies that are the same to them."""

    def __init__(self):
        self._said = {}

    def __call__(self, study: Study) -> list:
        parts = study.model_dump_json(include=OF_ROBOTS)
        its = study.real.robot, study.experiments.evidence, study.experiments.ensemble
        scenarios = Trainings(study).scenarios()
        same = parts, *scenarios, repr(its)
        if same not in self._said:
            self._said[same] = check_robots(study, scenarios)
        return self._said[same]


def jobs_of(study: Study) -> Iterator[tuple[str, dict]]:
    """A job of each kind for all that the study consists of: of many chunks, the ends."""
    trainings, plan = Trainings(study), study.experiments
    once = "design study_mapping study_visits summary benchmark_table real_table"
    yield from ((rule, {}) for rule in once.split())
    yield from (("assignments", {"robot": robot}) for robot in study.robots)
    for scenario in trainings.scenarios():
        yield "scenario", {"scenario": scenario}
        yield "recording", {"recording": scenario}
    for learner, scenario in {learner: scenario for scenario, learner in trainings.runs}.items():
        for chunk in ends(seeds(study, learner), study.training.seeds_per_job):
            yield "train", {"scenario": scenario, "learner": learner, "chunk": chunk}
    for name in trainings.tuned():
        last = ends(searches(study, name), searches_per_job(study, name))[1]
        yield "search", {"training": name, "chunk": last}
        yield "search_sample", {"training": name}
    for learner, series in plan.ensemble.items():
        for name, its in series.items():
            last = ends(its.draws, plan.draws_per_job)[1]
            yield "ensemble_chunk", {"series": name, "learner": learner, "chunk": last}
    yield from (("benchmark_run", {"learner": learner}) for learner in study.benchmark.learners)
    yield from (("real_data", {"part": part}) for part in ("fit", "test"))
    yield from (("real_run", {"learner": learner}) for learner in study.real.learners)
    yield from (("real_twin", {"learner": learner}) for learner in study.real.twin)


def ends(total: int, size: int) -> tuple[int, int]:
    """The first chunk and the last one, which hold all."""
    numbers = chunks(total, size)
    assert bounds(numbers[0], total, size)["first"] == 0
    assert bounds(numbers[-1], total, size)["last"] == total
    return numbers[0], numbers[-1]


def assert_sense(study: Study, rules: Rules) -> None:
    """All jobs can be made and travel, and what they would draw and measure is something."""
    for rule, wildcards in jobs_of(study):
        text = rules.text(study, rule, **wildcards)
        assert "NaN" not in text and "Infinity" not in text
        json.loads(text)
    trainings = Trainings(study)

    def request():
        return Request(study, trainings, root_of(study.name), "search/{}.csv".format)

    assert "figure2" in drawn(study, request)
    if study.experiments.evidence:
        assert judging(request)
    its = study.training
    for learner in {learner for _, learner in trainings.runs}:
        iterations = rules_named(study, learner).iterations
        few = its.model_copy(update={"measurements": min(its.measurements, 100)})
        grid = few.during(iterations)
        assert grid[0] == 0 and grid[-1] == iterations
    for learner in study.benchmark.learners:
        budgets = [*study.benchmark.moves, *study.benchmark.longer]
        assert len(budgets) == len({*budgets})
        if learner not in peers():
            most = MOVES * rules_named(study, learner).iterations
            assert [each for each in budgets if each % MOVES == 0 and each <= most]
    learner = rules_of(next(iter(study.learners.values())))
    trials = draw(learner, study.search.ranges.model_dump(), 2, np.random.default_rng(1))
    assert (trials.to_numpy() > 1e-9).all() and np.isfinite(trials.to_numpy()).all()


@pytest.fixture(scope="module")
def robots() -> Robots:
    return Robots()


def test_thousands_of_settings_are_tried():
    assert sum(len([*settings(key)]) for key in TREE) > 3000


@pytest.mark.parametrize("key", TREE)
def test_a_setting_is_refused_in_a_sentence_or_makes_sense(key, robots, rules, monkeypatch):
    monkeypatch.chdir(ROOT)
    accepted, wrong = 0, []
    for path, value in settings(key):
        try:
            study = read_study(
                SHIPPED, overlay(path, value), checks=(check, partial(named_files, ROOT), robots)
            )
            assert_sense(study, rules)
            accepted += 1
        except InvalidConfiguration as error:
            unclear = [line for line in error.mistakes if not REFUSAL.fullmatch(line)]
            wrong += [(path, value, line) for line in unclear]
        except Exception as error:  # the very thing that must not happen
            wrong.append((path, value, repr(error)))
    assert wrong == []
    assert (accepted > 0) == (key not in FEW), "or nothing is known of what passes"
