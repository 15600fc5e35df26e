"""What should one use today? No part of the default run."""

SIDE_BY_SIDE = 5  # scenarios in a job: a move takes half the time where the controller solves a hundred in one call


def batches(names):
    """The scenarios that share a job, and so a robot, by the name of their batch."""
    by_robot = {}
    for name in names:
        by_robot.setdefault(scenarios.robot_of(name, config)[1], []).append(name)
    shared = [own[first : first + SIDE_BY_SIDE] for own in by_robot.values() for first in range(0, len(own), SIDE_BY_SIDE)]
    return {str(number): batch for number, batch in enumerate(shared)}


BATCHES = batches(BENCHMARK["scenarios"])


rule benchmark_run:
    input:
        code=code("benchmark.py"),
        scenarios=lambda w: expand(rules.scenario.output[0], scenario=BATCHES[w.batch]),
    output:
        f"{RESULTS}/benchmark/{{learner}}/{{batch}}.parquet",
    params:
        scenarios=lambda w: BATCHES[w.batch],
        benchmark={key: BENCHMARK[key] for key in ("seeds", "moves", "longer")},
        learner=lambda w: entry_of(w.learner) if training_of(w.learner, config["learners"]) else w.learner,
        tests=TRAINING["tests"],
        seed=config["seed"],
    message:
        "Let {wildcards.learner} work through {params.scenarios}"
    script:
        "../scripts/benchmark.py"


rule benchmark_table:
    input:
        code=code("benchmark_table.py"),
        histories=expand(rules.benchmark_run.output, learner=BENCHMARK["learners"], batch=BATCHES),
    output:
        table=f"{RESULTS}/benchmark.csv",
        reached=f"{RESULTS}/benchmark_moves.csv",
        seconds=f"{RESULTS}/benchmark_seconds.csv",
    params:
        thresholds=BENCHMARK["thresholds"],
        seed=config["seed"],
    message:
        "Put the benchmark together"
    script:
        "../scripts/benchmark_table.py"


REAL = config["real"]


rule real_data:
    input:
        code=code("real_data.py"),
    output:
        f"{RESULTS}/real/{{part}}.csv",
    params:
        source=lambda w: REAL["data"][w.part],
    wildcard_constraints:
        part="fit|test",
    message:
        "Bring the poses of the real arm to {wildcards.part}"
    script:
        "../scripts/real_data.py"


rule real_run:
    input:
        code=code("real_run.py"),
        fit=f"{RESULTS}/real/fit.csv",
        test=f"{RESULTS}/real/test.csv",
    output:
        f"{RESULTS}/real/runs/{{learner}}.csv",
    params:
        real={key: REAL[key] for key in ("robot", "poses", "subsets")},
        seed=config["seed"],
    message:
        "Let {wildcards.learner} learn from recorded poses of the real arm"
    script:
        "../scripts/real_run.py"


rule real_twin:
    input:
        code=code("real_twin.py"),
        fit=f"{RESULTS}/real/fit.csv",
    output:
        f"{RESULTS}/real/twin/{{learner}}.csv",
    params:
        real={key: REAL[key] for key in ("robot", "poses", "subsets")},
        learner=lambda w: entry_of(w.learner),
        seed=config["seed"],
    message:
        "Let {wildcards.learner} learn on a twin of the real arm"
    script:
        "../scripts/real_twin.py"


rule real_table:
    input:
        code=code("real_table.py"),
        runs=[
            *expand(rules.real_run.output, learner=REAL["learners"]),
            *expand(rules.real_twin.output, learner=REAL["twin"]),
        ],
    output:
        f"{RESULTS}/real.csv",
    params:
        seed=config["seed"],
    message:
        "Put the results on the real arm together"
    script:
        "../scripts/real_table.py"


# Its part on the real arm is written where `real` was run before.
rule guidance:
    input:
        code=code("guidance.py"),
        template="workflow/templates/guidance.md.j2",
        benchmark=rules.benchmark_table.output,
        real=lambda w: [path for path in rules.real_table.output if Path(path).exists()],
    output:
        update("docs/guidance.md"),
    message:
        "Write the page of guidance"
    script:
        "../scripts/guidance.py"


rule benchmark:
    input:
        rules.guidance.output,
        expand(rules.figure.output, figure="figure12"),


rule real:
    input:
        rules.real_table.output,
        expand(rules.figure.output, figure="figure13"),
