"""What a result depends on: every leaf of the configuration is changed, one at a time.

The workflow is read once. For each change, the functions that give inputs and parameters of all
its jobs are asked again: where they differ, the job runs again, and all that follows from it.
"""

import copy
import json
import re
from fnmatch import fnmatch
from functools import partial
from unittest import mock

import pandas as pd
import pytest
import yaml
from snakemake.settings.types import DAGSettings

from replication.config.messages import InvalidConfiguration
from replication.config.reading import read_study
from replication.config.shipped import EFFORTS, REFERENCE, SEARCHED
from replication.running.studies import layers_of
from replication.training.samples import sample_of, sought
from replication.training.trainings import Trainings
from tests.conftest import ROOT, copy_project
from tests.rules import Rules

TABLE = yaml.safe_load((ROOT / "tests" / "provenance.yaml").read_text(encoding="utf-8"))

RULES = TABLE["rules"]


def rules_in(text: str) -> set[str]:
    """The rules that a text names, one by one or by their group."""
    return {rule for word in text.split() for rule in TABLE["groups"].get(word, word).split()}


# Others are those of experiments that came later: they are shown to depend on something below.
NAMED = set().union({"report_pages"}, *map(rules_in, RULES.values()))


def leaves(tree, path=()):
    """Paths of all leaves: a list of words is one, a list of numbers or quantities as many."""
    if isinstance(tree, dict):
        for key, value in tree.items():
            yield from leaves(value, (*path, key))
    elif isinstance(tree, list) and any(isinstance(item, dict) for item in tree):
        for index, value in enumerate(tree):
            yield from leaves(value, (*path, index))
    else:
        yield path


def at(tree, path):
    for key in path:
        tree = tree[key]
    return tree


QUANTITY = re.compile(r"([-+]?[\d.]+) (mm|cm|m|deg|rad|rad/Nm)")
OTHERS = {
    "maps": {"single": "separate", "separate": "single"},
    "theta": {"values": "increments", "increments": "values"},
    "jacobian": {"values": "increments", "increments": "values"},
    "schedule": {"exponential": "equal_visits", "equal_visits": "exponential"},
    "assigned": {"links": "encoders", "encoders": "links"},
    "settings": {"shipped": "own", "own": "shipped"},
    "robot": {"ur10": "ur5", "ur5": "ur10"},
    "scenario": {"links_encoders": "links"},
}


def changes(path, value):
    """Other values for a leaf, until one of them makes a difference."""
    if isinstance(value, bool):
        yield not value
    elif isinstance(value, int):
        yield from (value + 1, 2 * value, max(value // 3, 1))
    elif isinstance(value, float):
        yield 1.01 * value
    elif value is None:
        yield "a_copy.csv"
    elif isinstance(value, str):
        if match := QUANTITY.fullmatch(value):
            yield f"{1.5 * float(match[1]) + 0.5:g} {match[2]}"
        elif path[-1] in OTHERS:
            yield OTHERS[path[-1]][value]
        elif path[-1] == "sha256":
            yield value[::-1]
        else:
            yield f"{value}_changed"
    elif isinstance(value, list) and value:
        word = isinstance(value[0], str) and not QUANTITY.fullmatch(value[0])
        yield value[1:] if word else [next(changes((*path, 0), value[0])), *value[1:]]
        yield value[:-1]


class Workflow(Rules):
    """The workflow with these targets, read once."""

    def __init__(self, folder, targets):
        with self.reading(folder) as api:
            api.dag(DAGSettings(targets=set(targets)))
            workflow = api._workflow
            workflow._prepare_dag(forceall=True, ignore_incomplete=True, lock_warn_only=True)
            workflow._build_dag()
            self.jobs = [(job.rule, job.wildcards) for job in workflow.dag.jobs]
            self._read = [[*map(str, job.input)] for job in workflow.dag.jobs]
        self.names = workflow.globals

    def sample(self, studies, name):
        """Where the searches for a training of the shipped study lie, were these the studies."""
        self.become(studies)
        return self.names["sample_at"]("results", name)

    def asks(self, studies):
        """Rule, inputs and parameters of every job, were these the studies, by folder."""
        self.become(studies)
        return [(rule.name, self._job(rule, wildcards)) for rule, wildcards in self.jobs]

    def uncounted(self, studies):
        """Rules with a script, and files that they read, no rule makes and no parameter counts."""
        self.become(studies)
        found = set()
        for (rule, wildcards), paths in zip(self.jobs, self._read, strict=True):
            if digest := dict(rule.params.items()).get("code"):
                with mock.patch("workflow.dependencies._digest", "<{}>".format):
                    counted = digest(wildcards)
                given = (path for path in paths if not path.startswith("results/"))
                found |= {(rule.name, path) for path in given if f"<{path}>" not in counted}
        return found

    def _job(self, rule, wildcards):
        params = [its for name, its in rule.params.items() if name != "code"]
        try:
            answers = [ask(wildcards) for ask in (*rule.input, *params) if callable(ask)]
        except Exception as error:  # a job that no longer makes sense is one that has changed
            return repr(error)
        return [
            sorted(map(str, answer)) if isinstance(answer, list) else answer for answer in answers
        ]


def studies_of(tree):
    """The shipped study and one beside it, were this config.yaml."""
    others = [ROOT / "workflow" / "studies" / f"{name}.yaml" for name in ("quick", "ur3")]
    read = partial(read_study, tree, checks=())
    return {"results": read(), "results/studies/ur3": read(*layers_of(others[-1], others))}


def changed_leaves(tree):
    """Each leaf of the configuration, and trees with other values of it."""
    for path in leaves(tree):
        others = []
        for value in changes(path, at(tree, path)):
            other = copy.deepcopy(tree)
            at(other, path[:-1])[path[-1]] = value
            others.append(other)
        yield ".".join(map(str, path)), others


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """A copy of the project with a shipped sample of the search for every training."""
    folder = copy_project(tmp_path_factory.mktemp("provenance"))
    study = read_study(folder / "config.yaml", checks=())
    for name in Trainings(study).tuned():  # of which the workflow reads the head alone
        path = folder / SEARCHED / f"{name}.csv"
        path.parent.mkdir(exist_ok=True)
        path.write_text(sample_of(sought(study, name), pd.DataFrame()))
    for path in (REFERENCE, EFFORTS):  # measured once, and shipped
        (folder / path).touch()
    return folder


@pytest.fixture(scope="module")
def tree(project):
    """The configuration; what an anchor shares is many leaves."""
    tree = yaml.safe_load((project / "config.yaml").read_text(encoding="utf-8"))
    return json.loads(json.dumps(tree))


@pytest.fixture(scope="module")
def workflow(project):
    searched = [f"results/search/{name}_200.csv" for name in ("improved", "ritter")]
    targets = ["all", "benchmark", "real", "ur3", *searched, "results/universes/design.csv"]
    with mock.patch("workflow.dependencies.code", return_value=""):
        return Workflow(project, targets)


@pytest.fixture(scope="module")
def depending(workflow, tree):
    """By leaf, the rules whose jobs ask for something else when it changes."""
    before = workflow.asks(studies_of(tree))
    found = {}
    for leaf, others in changed_leaves(tree):
        for other in others:
            try:
                now = workflow.asks(studies_of(other))
            except InvalidConfiguration:
                continue
            pairs = zip(before, now, strict=True)
            found[leaf] = {was[0] for was, now_ in pairs if was != now_}
            if found[leaf]:
                break
    return found


def of_all_jobs(test):
    """To ask every job takes long: it is done once."""
    return pytest.mark.slow(pytest.mark.xdist_group(name="jobs")(test))


@of_all_jobs
def test_a_study_that_asks_for_more_searches_than_are_shipped_has_its_own(workflow, tree):
    shipped, own = f"{SEARCHED}/improved_200.csv", "results/search/improved_200.csv"
    for searches, path in ((12, shipped), (5, shipped), (13, own)):
        other = copy.deepcopy(tree)
        other["search"]["searches"] = searches
        assert workflow.sample(studies_of(other), "improved_200") == path


@of_all_jobs
def test_what_depends_on_a_leaf_runs_again_and_nothing_else(depending):
    wrong = {}
    for leaf, rules in depending.items():
        expected = rules_in(
            next(its for path, its in TABLE["rules"].items() if fnmatch(leaf, path))
        )
        if any(fnmatch(leaf, pattern) for pattern in TABLE["reported"]):
            expected.add("report_pages")
        found = {re.sub(r"(report_pages)_.*", r"\1", rule) for rule in rules} & NAMED
        if found != expected:
            wrong[leaf] = sorted(found ^ expected)
    assert wrong == {}


@of_all_jobs
def test_every_leaf_makes_a_difference_and_every_job_with_arguments_depends_on_one(
    workflow, depending
):
    assert [leaf for leaf, rules in depending.items() if not rules] == []
    assert len(depending) > 200
    asking = {rule.name for rule, _ in workflow.jobs if "arguments" in dict(rule.params.items())}
    assert asking <= set().union(*depending.values())


@of_all_jobs
def test_what_a_job_reads_and_no_rule_makes_counts_by_its_content(workflow, tree):
    assert workflow.uncounted(studies_of(tree)) == set()


def test_a_job_sees_nothing_but_its_files_and_its_rule_s_parameters():
    text = (ROOT / "workflow" / "scripts" / "call.py").read_text(encoding="utf-8")
    assert {*re.findall(r"snakemake\.(\w+)", text)} == {"params", "input", "output", "rule", "log"}
    assert not re.search(r"config\.yaml|read_study", text)
    for path in (ROOT / "recalib" / "study").rglob("*.py"):
        if "configuration" not in path.parts and path.name != "studies.py":
            assert "read_study" not in path.read_text(encoding="utf-8"), path
