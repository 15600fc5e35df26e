"""All that configurations mean, what scenarios are made of and which trainings follow, as kept."""

from pathlib import Path

import numpy as np
import pytest
from pydantic import TypeAdapter, ValidationError

from recalib.damaged.damage import BaseShift, EncoderShift, LinkShortening
from recalib.damaged.disturbances import Noise, Outliers, Repeatability
from recalib.damaged.nongeometric import Backlash, EccentricGear, Sag
from recalib.errors import RecalibError
from replication.config import units
from replication.config.damages import Assigned, Entry
from replication.config.study import PaperDamage
from replication.config.values import from_file, from_mapping, shown
from replication.scenarios.assignments import assign
from replication.scenarios.nominal import digest_of
from replication.scenarios.plants import nominal_controller, nominal_robot, resolve
from replication.running.studies import read_studies
from replication.training import trainings
from replication.training.trainings import Trainings
from tests.conftest import ROOT, changed
from tests.kept import plain

TYPES = {
    name: its
    for name, its in vars(units).items()
    if name[0].isupper() and hasattr(its, "__metadata__") and not getattr(its, "__parameters__", ())
}
TEXTS = (
    *("4 cm", "-4cm", " 0.2  mm ", "1e-3 m", "3 km", "4", "0 m", "101 m", "-100 m", "1 mm"),
    *("0.9 mm", "-3 deg", "0.5 rad", "180 deg", "181 deg", "-181 deg", "179.9 deg", "101 rad"),
    *("0.05 deg", "0.1 deg", "2e-4 rad/Nm", "0.01 deg/Nm", "1.1 rad/Nm", "-1 deg/Nm", "inf m"),
    *("-180 deg", "-101 rad", "100 rad", "-100 rad", "100 m", "-101 m", "1 rad/Nm", "-0.1 m"),
    *("0 deg", "0.06 deg"),
    *("ur10", "Ur_10", "10ur", "ab", "a" * 61, "", "https://a.b", "http://a.b", "0f" * 32),
)
NUMBERS = (0, 1, 2, -1, 4.0, 0.5, 1e-4, 1e-3, 999.0, 1001.0, 2e4, 10_000, 10_001, 10**6, 10**6 + 1)
NUMBERS = (*NUMBERS, 2**32 - 1, 2**32, float("nan"), True, None)
ENTRY = TypeAdapter(Entry)
EVERY = (
    BaseShift((0.01, -0.02, 0.03), (0.04, -0.05, 0.06)),
    LinkShortening("forearm_link", 0.04, "axis"),
    EncoderShift("elbow_joint", -0.05),
    EccentricGear("wrist_1_joint", 0.01, 0.3),
    Sag("shoulder_lift_joint", 1e-4),
    Backlash("wrist_2_joint", 0.002),
    Noise(2e-4, 3e-4),
    Repeatability(5e-4),
    Outliers(0.2, 0.05),
    Assigned(assigned="encoders"),
)


def read(adapter: TypeAdapter, value):
    """What it is read as, or why it is not."""
    try:
        return adapter.validate_python(value)
    except ValidationError as error:
        return error.errors()[0]["msg"]


def test_what_types_of_values_take_is_as_kept(data_regression):
    several = [[1, 2], [2, 1], [1, 1], []]
    found = {}
    for name, its in TYPES.items():
        adapter = TypeAdapter(its)
        taken = {repr(value): read(adapter, value) for value in (*TEXTS, *NUMBERS, *several)}
        refused = [its for its in taken.values() if isinstance(its, str) and " " in its]
        found[name] = {
            "schema": adapter.json_schema(),
            "taken": {key: value for key, value in taken.items() if value not in refused},
            "refused": [*dict.fromkeys(refused)],
        }
    data_regression.check(plain(found))


def test_ordered_and_distinct_values_are_as_kept(data_regression):
    kinds = {
        "distinct": units.Distinct[units.Count],
        "some": units.SomeDistinct[units.Name],
        "ordered": units.Ordered[units.Angle],
        "numbers": units.Ordered[units.Scale],
    }
    values = [], [1, 2], [2, 1], [3, 3], ["a", "b"], ["a", "a"], ["1 deg", "2 deg"]
    values = *values, ["2 deg", "1 deg"], ["1 rad", "1 rad"], [0.5, 0.5], [0.5, 0.4], [1, 2, 3]
    data_regression.check(
        plain(
            {
                kind: [read(TypeAdapter(its), value) for value in values]
                for kind, its in kinds.items()
            }
        )
    )


TEXT = """\
# a study
names: {one: 1, two: -2.5e3, three: yes, four: 0x10, five: 1:30, six: 2026-11-23}
list: [true, False, ~, null, .inf, -.inf, 1e5, +7, 1_000, "4", '', 4 cm]
base: &base {a: 1, b: [2, {c: 3}]}
other: {<<: *base, a: 9}
again: *base
empty:
zeros: [08, -010]
"""
WRONG = {
    "twice": "a: 1\nb: {c: 1,\n  c: 2}\n",
    "tab": "a:\n\tb: 1\n",
    "indented": "a: 1\n  b: 2\n",
    "block": "a:\n    b: {c: 1}\n      d: 2\n",
    "bracket": "a: [1, 2\nb: 3\n",
    "tag": "a: !!python/name:os.getcwd x\n",
    "tagged": "a: !!int 'x'\n",
    "key": "? [a]\n: 1\n",
    "scalar": "seed\n",
}


def places(value, path=()) -> dict:
    """Where each value stands."""
    its = {".".join(map(str, path)) or "all": shown(value.place)}
    match value.content:
        case dict():
            parts = value.content.items()
        case list():
            parts = enumerate(value.content)
        case _:
            return its
    for key, part in parts:
        its |= places(part, (*path, key))
    return its


def test_values_and_their_places_are_as_kept(tmp_path, monkeypatch, data_regression):
    monkeypatch.chdir(tmp_path)
    Path("study.yaml").write_text(TEXT, encoding="utf-8")
    whole = from_file("study.yaml")
    over = from_mapping({"names": {"one": 5, "seven": (1, 2)}, "list": [3], "base": None})
    refused = {}
    for name, text in WRONG.items():
        Path(f"{name}.yaml").write_text(text, encoding="utf-8")
        with pytest.raises(RecalibError) as wrong:
            from_file(f"{name}.yaml")
        refused[name] = str(wrong.value)
    found = {
        "plain": whole.plain(),
        "places": places(whole),
        "under": whole.under(over).plain(),
        "places under": places(whole.under(over)),
        "at": [
            shown(whole.at(path).place) for path in (("base", "b", 1, "c", 4), ("list", 99), ())
        ],
        "refused": refused,
    }
    data_regression.check(plain(found))


def test_scenarios_as_resolved_and_their_plants_are_as_kept(plan, tmp_path, data_regression):
    its = changed(plan.nominal("ur10"), beyond=0.05, limits={"elbow_joint": (0.3, 2.9)})
    kept = tmp_path / "assignment.json"
    damage = PaperDamage.model_construct(
        shorten=(0.02, 0.03), shift=(0.05,), published=plan.study.paper_damage.published, poses=2
    )
    kept.write_text(assign(its, damage, seed=5)[1].model_dump_json())
    links, encoders = (Assigned(assigned=part) for part in ("links", "encoders"))
    scenarios = [
        resolve("all", its, EVERY[:9], 5, 7),
        resolve("assigned", its, (links, EVERY[6], encoders), 5, 7, kept),
    ]
    again = [type(one).model_validate_json(one.model_dump_json()) for one in scenarios]
    commands = np.random.default_rng(2).uniform(-1, 1, (2, 4, 6))
    controller = again[0].controller()
    plant = scenarios[0].plant(controller, 11, [1, 2], "another stream")
    files = [tmp_path / name for name in ("one", "two")]
    for number, file in enumerate(files):
        file.write_text(f"text {number}")
    robot = nominal_robot(its)
    found = {
        "resolved": [[one.model_dump(exclude={"nominal"}), one.nominal.name] for one in scenarios],
        "moves": [one.plant(controller, 11, [3]).execute(commands[:1]) for one in again],
        "other moves": plant.execute(commands),
        "robot": [robot.name, robot.home, robot.lower, robot.upper, robot.workspace, robot.joints],
        "arms": [one.arm(robot).forward(commands[0]) for one in scenarios],
        "margin": nominal_controller(its).solve(robot.workspace.to_poses(commands[0])).angles,
        "digest": [digest_of(files), digest_of(files[:1])],
    }
    data_regression.check(plain(found))


@pytest.fixture(scope="module")
def studies():
    return read_studies(ROOT, [], {}, asking=False)[1]


def uneven(study):
    """One whose own scenario is not among those of its learners."""
    parts = {"scenarios": ("links", "noise-ur3"), "robots": ("z1", "ur10"), "switches": False}
    parts |= {"ladder": {"improved": (90, 30, 200)}, "beside": ("ritter_200", "improved_30")}
    experiments = study.experiments.model_copy(update=parts)
    search = study.search.model_copy(update={"searches": 5, "searches_long": 3, "short": 90})
    return study.model_copy(update={"experiments": experiments, "search": search})


STUDIES = "replication", "quick", "bent", "coarse", "panda", "ur3", "uneven"


@pytest.mark.parametrize("name", STUDIES)
def test_the_trainings_of_a_study_are_as_kept(name, studies, data_regression):
    by_name = {its.name: its for its in studies.values()}
    study = by_name.get(name) or uneven(by_name["replication"])
    every, plan = Trainings(study), study.experiments
    learners = [*dict.fromkeys(learner for _, learner in every.runs), "improved_77", "ritter_900"]
    found = {
        "runs": [" ".join(run) for run in every.runs],
        "tuned": every.tuned(),
        "scenarios": every.scenarios(),
        "ladders": {learner: every.ladder(learner) for learner in (*plan.ladder, "nobody")},
        "elsewhere": trainings.elsewhere(study),
        "robots of scenarios": [trainings.scenario_of(study, its) for its in every.scenarios()],
        "switched": trainings.switched(study),
        "short": trainings.ritter_short(study),
        "budget": trainings.budget(study),
        "measuring": trainings.measuring(study),
        "learners": {
            learner: [
                str(trainings.training(study, learner)),
                trainings.searches(study, learner),
                trainings.seeds(study, learner),
                every.name(learner),
                [*trainings.rules(study, learner).model_dump().values()],
            ]
            for learner in learners
        },
        "peers": [trainings.rules_unless_peer(study, its) for its in ("affine", "ritter_55")],
        "horizons": np.array(study.universes.horizons),
        "workspaces": {
            robot: its.workspace.scale_to(study.robots[study.robot].workspace)
            for robot, its in study.robots.items()
        },
    }
    data_regression.check(plain(found))
