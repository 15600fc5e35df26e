"""Figures: each is drawn from what it declares, and an unchanged result leaves it unchanged."""

from recalib.study.plots.registry import FIGURES, drawn, possible


def figure_needs(wildcards):
    return asked(wildcards.root, FIGURES[wildcards.figure].needs)


rule figure:
    input:
        evidence=lambda w: figure_needs(w).inputs,
    output:
        LAYOUT.figure("{figure}"),
        LAYOUT.figure("{figure}", ".png"),
    wildcard_constraints:
        figure="|".join(FIGURES),
    threads: 1
    resources:
        **room(mem_mb=2000, runtime=10),
    params:
        code=lambda w: made_from(
            "figure.py", FIGURES[w.figure].home, reads=lambda w: figure_needs(w).inputs
        )(w),
        job=lambda w: as_text(figure_needs(w)),
    message:
        "Draw {wildcards.figure}"
    script:
        "../scripts/figure.py"


def figures_of(root):
    """The figures of a study, for which it has what they need."""
    its, names = Layout(root), drawn(STUDIES[root], request(root))
    return [its.figure(name, suffix) for name in names for suffix in (".svg", ".png")]


def ideas_of(root):
    """The pictures of ideas: they are explained once, with the shipped study."""
    return possible(["ideas"], request(root)) if root == RESULTS else []
