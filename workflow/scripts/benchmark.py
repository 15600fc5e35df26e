"""Let one learner work through one scenario of the benchmark, and measure it at every budget of moves."""

from recalib import campaign
from recalib.benchmark import Timed, entrant
from recalib.experiment import run
from recalib.progress import progress_bar
from recalib.storage import whole
from workflow.scripts.job import job

with job(snakemake):
    config, scenario, name = snakemake.config, snakemake.wildcards.scenario, snakemake.wildcards.learner
    runs = range(config["benchmark"]["seeds"])
    which = entrant(name, config)
    controller, plant = campaign.load_plant(snakemake.input.scenario, config, runs)
    learner = Timed(which.make(len(runs), controller))
    with progress_bar(f"{name} on {scenario}", which.iterations) as progress:
        history = run(
            plant,
            learner,
            campaign.desired_poses(config["seed"], scenario, runs, which.iterations),
            campaign.test_poses(config["seed"], scenario, runs, config["training"]["tests"]),
            which.measure_at([*config["benchmark"]["moves"], *config["benchmark"]["longer"]]),
            progress,
        )
    seconds = learner.seconds / (len(runs) * which.iterations * which.moves_per_iteration)
    frame = history.to_frame().assign(scenario=scenario, learner=name, seconds_per_move=seconds)
    with whole(snakemake.output[0]) as path:
        frame.to_parquet(path, index=False)
