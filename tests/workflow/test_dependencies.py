import os

import pytest
from snakemake.iocontainers import Wildcards

from replication.plots.registry import FIGURES
from tests.conftest import ROOT
from tests.test_architecture import files_of, imported
from workflow import dependencies

MODULES = [path for folder in ("recalib", "workflow") for path in (ROOT / folder).rglob("*.py")]


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_imports_are_seen_as_python_sees_them(path):
    ours = [name for name in imported(path) if name.startswith(("recalib", "workflow"))]
    found = dependencies.imported(path.relative_to(ROOT).as_posix())
    assert {*found} == set().union(*map(files_of, ours))


def test_a_training_depends_on_its_rules_and_not_on_figures_or_other_learners():
    needed = dependencies.modules("replication.training.campaign")
    assert {"recalib/learners/hierarchical.py", "recalib/nominal/controller.py"} <= {*needed}
    assert "workflow/scripts/call.py" in needed
    others = ("plots", "evidence", "recording", "identification", "learners/geo", "regression")
    assert not [path for path in needed if any(other in path for other in others)]


@pytest.mark.parametrize(
    ("rule", "which", "module"),
    [
        ("benchmark_run", {"learner": "hybrid"}, "hybrid"),
        ("benchmark_run", {"learner": "affine"}, "polynomial"),
        ("real_run", {"learner": "gaussian_process"}, "gaussian_process"),
        ("real_twin", {"learner": "improved"}, "hybrid"),  # that identifies the twin
        ("recording", {"recording": "links_encoders"}, "geometric"),
    ],
)
def test_a_job_depends_on_the_peer_that_it_is_told(rule, which, module, rules, study, monkeypatch):
    monkeypatch.setattr(dependencies, "code", lambda *named: " ".join([*named, ""]))
    rules.become({"results": study})
    digest = dict(rules.workflow.get_rule(rule).params.items())["code"]
    named = digest(Wildcards(fromdict={"root": "results"} | which)).split()
    assert f"recalib.learners.{module}" in named
    assert len([name for name in named if name.startswith("recalib.learners")]) == 1


def test_a_figure_depends_on_the_module_that_draws_it_and_not_on_other_figures():
    needed = dependencies.modules("replication.plots.registry", FIGURES["figure5"].home)
    homes = {figure.home.replace(".", "/") + ".py" for figure in FIGURES.values()}
    assert homes & {*needed} == {"replication/plots/mapping.py"}
    palette = {"replication/plots/palette.py", "replication/judgement/measured.py"}
    assert palette < {*needed}


def test_an_edited_module_changes_the_digest(tmp_path, monkeypatch):
    for name in ("recalib/__init__.py", "workflow/__init__.py", "workflow/scripts/__init__.py"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("")
    (tmp_path / "workflow/scripts/call.py").write_text("")
    (tmp_path / "recalib/a.py").write_text("from recalib.one import (\n    f,\n    g,\n)\n")
    (tmp_path / "recalib/one.py").write_text("def f():\n    from recalib import two\n")
    monkeypatch.setattr(dependencies, "ROOT", tmp_path)
    seen = set()
    for text in ("x = 1\n", "x = 2\n", "x = 1\n"):
        (tmp_path / "recalib/two.py").write_text(text)
        for function in vars(dependencies).values():
            getattr(function, "cache_clear", int)()
        seen.add(dependencies.code("recalib.a"))
    assert len(seen) == 2


def test_a_source_counts_by_what_stands_in_it_whatever_its_date(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    template, seen = tmp_path / "page.md.j2", []
    reads = [template.name, "not_there.csv"]
    digest = dependencies.calls(
        "replication.pages.rendering.page", reads=lambda w: reads
    )["code"]
    for written in ("as it was", "edited", "as it was"):
        template.write_text(written)
        os.utime(template, (0, 0))
        dependencies._digest.cache_clear()
        seen.append(digest(None))
    assert seen[0] == seen[2] != seen[1]


def test_every_rule_with_a_script_counts_its_sources():
    for path in (ROOT / "workflow" / "rules").glob("*.smk"):
        text = path.read_text(encoding="utf-8")
        assert text.count("    script:\n") == text.count("**calls(") == text.count("/call.py")
