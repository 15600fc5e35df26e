"""Whatever stands in config.yaml is refused in a sentence before any work starts, or makes sense.

Every part of the configuration is replaced by values that people mistype and machines invent. What
is accepted must give a study all of whose jobs can be made.
"""

import math
import re
from functools import partial

import numpy as np
import pytest

from replication.campaign.variants import needed, variants
from replication.config.messages import InvalidConfiguration
from replication.config.reading import read_study
from replication.config.shipped import root_of
from replication.config.study import Study
from replication.config.values import from_file
from replication.pages.names import pages_of
from replication.plots.figures import figures_of
from replication.running.consistency import check
from replication.running.geometry import check_robots
from replication.running.studies import named_files
from replication.scenarios.plants import nominal_of
from replication.training.plan import places
from replication.training.settings import Space
from replication.training.tuned import rules_of, trained
from tests.conftest import ROOT

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
    r"(: (unknown|no valid) \w+; .+|: this name has another meaning; try: another name"
    r"| (is|has|lacks|moves) .+; ((valid|expected): .+|did you mean [\w.]+\?)"
    r"|: .+ again; expected: once| is missing: .+| lacks [\w, ]+| does not fit: .+)",
    re.DOTALL,
)


def parts(tree, path=(), kind=()):
    """The path of every part, and its kind: the same for all robots and for a list's entries."""
    yield path, kind
    if isinstance(tree, dict):
        for key, value in tree.items():
            part = "each" if path and path[-1] in NAMED else key
            yield from parts(value, (*path, key), (*kind, part))
    elif isinstance(tree, list):
        for index, value in enumerate(tree):
            yield from parts(value, (*path, index), (*kind, "each"))


def replacements(value):
    """Other values, of which some are valid in its place."""
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
            entry = next(iter(value.values()))
            yield from ({"a/b": entry}, {"$(reboot)": entry}, {"twin": entry}, {"": entry}, [entry])


def settings(key):
    """Paths below a key of the configuration, each with a replacement of the value there."""
    kinds = set()
    for path, kind in parts(TREE[key], (key,), (key,)):
        if kind not in kinds:
            kinds.add(kind)
            value = at(TREE, path)
            distinct = {repr(value): None} | {repr(new): new for new in replacements(value)}
            yield from ((path, new) for new in [*distinct.values()][1:])


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


OF_ROBOTS = {"robot", "scenario", "robots", "controller", "paper_damage", "scenarios"}


class RobotChecks:
    """The mistakes that `check_robots` finds, once for all studies that are equal to it."""

    def __init__(self):
        self._mistakes = {}

    def __call__(self, study: Study) -> list:
        fields = study.model_dump_json(include=OF_ROBOTS)
        experiments = study.real.robot, study.experiments.evidence, study.experiments.ensemble
        key = fields, *places(study), repr(experiments)
        if key not in self._mistakes:
            self._mistakes[key] = check_robots(study)
        return self._mistakes[key]


def assert_sense(study: Study) -> None:
    """A job gets the same study, and something to train, draw and measure."""
    text = study.model_dump_json()
    assert "NaN" not in text and "Infinity" not in text
    assert Study.model_validate_json(text) == study
    root = root_of(study.name)
    for place, learners in places(study).items():
        assert learners and all(learners.values())
        nominal_of(study, place.robot)
        paths = [place.scenario_file(root), *(place.history_file(root, name) for name in learners)]
        assert len(paths) == len({*paths})
    few = study.training.model_copy(update={"measurements": min(study.training.measurements, 100)})
    for learner, iterations in trained(study):
        grid = few.during(iterations)
        assert grid[0] == 0 and grid[-1] == iterations
        space = Space(rules_of(study.every_learner[learner]), study.search.ranges)
        middle = space.rows(np.full((1, len(space.coordinates)), 0.5))
        assert (middle > 1e-9).all() and np.isfinite(middle).all()
    assert "figure1" in figures_of(study) and pages_of(study)
    for name, variant in variants(study).items():
        assert needed(variant) or variant.lengths or variant.at_home, name
    budgets = [*study.benchmark.moves, *study.benchmark.longer]
    assert len(budgets) == len({*budgets})


@pytest.fixture(scope="module")
def robots() -> RobotChecks:
    return RobotChecks()


def test_thousands_of_settings_are_tried():
    assert sum(len([*settings(key)]) for key in TREE) > 3000


@pytest.mark.parametrize("key", TREE)
def test_a_setting_is_refused_in_a_sentence_or_makes_sense(key, robots, monkeypatch):
    monkeypatch.chdir(ROOT)
    accepted, failures = 0, []
    for path, value in settings(key):
        try:
            study = read_study(
                SHIPPED, overlay(path, value), checks=(check, partial(named_files, ROOT), robots)
            )
            assert_sense(study)
            accepted += 1
        except InvalidConfiguration as error:
            unclear = [line for line in error.mistakes if not REFUSAL.fullmatch(line)]
            failures += [(path, value, line) for line in unclear]
        except Exception as error:  # the very thing that must not happen
            failures.append((path, value, repr(error)))
    assert failures == []
    assert (accepted > 0) == (key not in FEW), "or nothing is known of what passes"
