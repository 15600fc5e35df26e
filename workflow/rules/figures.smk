"""Figures: committed, so that the README shows them, and written so that an unchanged result leaves them unchanged."""

DEFAULT = EXPERIMENTS["learners"]
LADDERS = [run for run in RUNS if tuned.training(run[1], config["learners"]).name in EXPERIMENTS["ladder"] and run[0] == PAPER]
ELSEWHERE = [f"{PAPER}-{robot}" for robot in EXPERIMENTS["robots"]]

FIGURE_INPUTS = {
    "figure1": histories([(PAPER, "improved")]),
    "figure2": histories(product([PAPER], DEFAULT)),
    "figure3": histories(product(SCENARIOS, DEFAULT)),
}
if EXPERIMENTS["evidence"]:
    FIGURE_INPUTS |= {
        "figure4": histories(product([PAPER], [*DEFAULT, *EXPERIMENTS["paper"]])),
        "figure5": rules.study_mapping.output.coupling,
        "figure6": [],  # drawn from the sample of the search
        "figure7": rules.study_mapping.output.propagation,
        "figure8": rules.study_visits.output,
        "figure9": histories(LADDERS),
        "figure10": rules.claims.input.assignments,
        "figure11": [*ENSEMBLES.values(), *histories(product([PAPER, *ELSEWHERE], DEFAULT))],
    }


# Drawn by the targets `benchmark` and `real` alone.
OF_TARGETS = {"figure12": f"{RESULTS}/benchmark.csv", "figure13": f"{RESULTS}/real.csv"}


rule figure:
    input:
        code=code("figure.py"),
        evidence=lambda w: (FIGURE_INPUTS | OF_TARGETS)[w.figure],
    output:
        svg=f"{FIGURE_FOLDER}/{{figure}}.svg",
        png=f"{FIGURE_FOLDER}/{{figure}}.png",
    params:
        trials=lambda w: digest(TRIALS) if w.figure == "figure6" else None,
    wildcard_constraints:
        figure="|".join(FIGURE_INPUTS | OF_TARGETS),
    message:
        "Draw {wildcards.figure}"
    script:
        "../scripts/figure.py"


FIGURES = expand(rules.figure.output, figure=FIGURE_INPUTS)
