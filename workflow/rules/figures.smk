"""Figures: each is drawn from what it declares, and an unchanged result leaves it unchanged."""

from replication.plots.registry import FIGURES, drawn, possible


def figure_evidence(wildcards):
    return asked(wildcards.root, FIGURES[wildcards.figure].needs)


rule figure:
    input:
        files=lambda w: figure_evidence(w).inputs,
    output:
        svg="{root}/figures/{figure}.svg",
        png="{root}/figures/{figure}.png",
    log:
        "{root}/logs/figure/{figure}.log",
    wildcard_constraints:
        figure="|".join(FIGURES),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=10),
    params:
        **calls(
            "replication.plots.registry.publish",
            also=lambda w: [FIGURES[w.figure].home],
            reads=lambda w: figure_evidence(w).inputs,
        ),
        arguments=lambda w: as_text(figure=w.figure, evidence=figure_evidence(w)),
    message:
        "Draw {wildcards.figure}"
    script:
        "../scripts/call.py"


def figures_of(root):
    """The figures of a study, for which it has what they need."""
    names = drawn(STUDIES[root], request(root))
    return expand("{root}/figures/{name}.{suffix}", root=root, name=names, suffix=["svg", "png"])


def ideas_of(root):
    """The pictures of ideas that show results: explained once, with the shipped study."""
    return possible(["ideas"], request(root)) if root == RESULTS else []
