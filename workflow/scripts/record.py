"""Record one damaged arm before and after its recalibration, learned with the first seed of the experiment."""

import hashlib
import importlib.metadata
import json
from pathlib import Path

from recalib.study import scenarios
from recalib.study.experiments import campaign, tuned
from recalib.study.recording import write_recording
from recalib.training import measuring_grid
from workflow.scripts.job import job

SEED = 0

with job(snakemake):
    config, scenario, plan = (
        snakemake.config,
        snakemake.wildcards.scenario,
        snakemake.params.training,
    )
    described = json.loads(Path(snakemake.input.scenario).read_text())
    names = snakemake.params.learners
    which = [tuned.training(name, config["learners"]) for name in names]
    iterations = which[0].iterations
    path = Path(snakemake.output[0])
    path.parent.mkdir(parents=True, exist_ok=True)
    write_recording(
        path,
        scenarios.parse_damages(described["damages"]),
        scenarios.load_controller(described["robot"], config),
        {
            name: tuned.build(each, 1, config["learners"], config["tuned"])
            for name, each in zip(names, which, strict=True)
        },
        campaign.desired_poses(config["seed"], scenario, [SEED], iterations)[0],
        campaign.test_poses(config["seed"], scenario, [SEED], plan["tests"])[0],
        measuring_grid(
            iterations, plan["measure_every"], plan["measure_evenly"], plan["measurements"]
        ),
        {
            "damage": json.dumps(described["damages"]),
            "robot": described["robot"],
            "seed": str(SEED),
            "config_sha256": hashlib.sha256(
                json.dumps(config, sort_keys=True).encode()
            ).hexdigest(),
            **{
                name: importlib.metadata.version(name)
                for name in ("pin", "rerun-sdk", "numpy", "scipy")
            },
        },
    )
