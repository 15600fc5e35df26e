"""Bad input gets a clear error before any work starts."""

import copy

import pytest
from snakemake.exceptions import WorkflowError
from snakemake.utils import validate

from tests.conftest import ROOT

SCHEMA = ROOT / "workflow" / "schemas" / "config.schema.yaml"


def at(config, path):
    *parents, key = path.split(".")
    for parent in parents:
        config = config[int(parent) if isinstance(config, list) else parent]
    return config, int(key) if isinstance(config, list) else key


def test_the_configuration_of_the_project_fits_its_schema(config):
    before = copy.deepcopy(config)
    validate(config, SCHEMA)
    assert config == before, "the schema fills in no defaults: the configuration says everything"


@pytest.mark.parametrize(
    "path",
    [
        "sed",
        "robots.ur10.tol",
        "robots.ur10.workspace.size",
        "controller.tolerance",
        "paper_damage.lengthen",
        "paper_damage.published.error",
        "scenarios.translation.0.turn",
        "learners.improved.jacobians",
        "experiments.learner",
        "training.sead",
        "search.trial",
        "search.ranges.width",
    ],
)
def test_an_unknown_key_is_refused_by_name(config, path):
    broken = copy.deepcopy(config)
    parent, key = at(broken, path)
    parent[key] = 1
    with pytest.raises(WorkflowError, match=key):
        validate(broken, SCHEMA)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("seed", -1),
        ("seed", "many"),
        ("robots.ur10.home.elbow_joint", "120 cm"),
        ("robots.ur10.home.elbow_joint", 120),
        ("robots.ur10.workspace.position", ["50 cm", "60 cm"]),
        ("robots.ur10.workspace.position.0", "-50 cm"),
        ("robots.ur10.workspace.orientation.0", "40 cm"),
        ("controller.greatest_condition", 0),
        ("paper_damage.shorten.0", "-1 cm"),
        ("paper_damage.shorten.0", "1 deg"),
        ("paper_damage.poses", 0),
        ("scenarios.links", [{"link": "forearm_link", "shorten": "-4 cm"}]),
        ("scenarios.links", [{"link": "forearm_link", "shorten": 4}]),
        ("scenarios.links", [{"assigned": "cables"}]),
        ("learners.improved.maps", "three"),
        ("learners.improved.supernet", [3, 0, 3]),
        ("learners.improved.supernet", [3, 3]),
        ("learners.improved.iterations", -200),
        ("learners.improved.iterations", 0),
        ("training.seeds", 0),
        ("training.seeds", -3),
        ("training.seeds", 2.5),
        ("search.ranges.initial_width", [-0.2, 5]),
        ("search.ranges.initial_rate", [0.2, 1.5]),
        ("search.ranges.initial_rate", [0, 1]),
        ("search.rounds", 0),
    ],
)
def test_an_impossible_value_is_refused_by_key(config, path, value):
    broken = copy.deepcopy(config)
    parent, key = at(broken, path)
    parent[key] = value
    with pytest.raises(WorkflowError) as caught:
        validate(broken, SCHEMA)
    assert path.split(".")[0] in str(caught.value)


def test_every_key_is_described():
    import yaml

    schema = yaml.safe_load(SCHEMA.read_text())

    def undescribed(node, path):
        for key, value in node.get("properties", {}).items():
            if "description" not in value:
                yield f"{path}.{key}"
            yield from undescribed(value, f"{path}.{key}")
            for part in (value.get("additionalProperties"), value.get("items")):
                if isinstance(part, dict):
                    yield from undescribed(part, f"{path}.{key}")

    assert list(undescribed(schema, "")) == []
