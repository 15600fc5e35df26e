"""Results of a small study, made up by formulas: all that figures are drawn from, in a second."""

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

from replication.campaign import DOUBLE, TWO_MAPS, lengths
from replication.campaign.variants import variants
from replication.config import CAMPAIGN, DESIGN, IMPROVED, RESULTS, RITTER, Study, read_study
from replication.judgement import Evidence, written
from replication.judgement.claims import judge
from replication.plots import STYLE, Figure, drawn
from replication.running import write
from replication.training import ERRORS, KINDS, UNCORRECTED, places, throughout
from tests.conftest import ROOT

NEEDED = {  # iterations for the improved system's errors, in the reference study
    RITTER: 9000,
    DOUBLE: 14_000,
    TWO_MAPS: 7000,
    "two_maps_jacobian": 5000,
    "two_maps_theta": 600,
    "two_maps_increments": 300,
    IMPROVED: 200,
}
LEFT = 0.04  # of the error, by the improved system
WORSE = {"improved_theta_values": 2.5, "improved_rough": 1.9, "two_maps_for_position_wide": 1.5}
INITIAL = np.array([8.4, 4.7])


def outcomes(study: Study) -> pd.DataFrame:
    """Errors fall with the iterations; those of other setups differ by some percent."""
    rows, random = [], np.random.default_rng(44)
    for setup in range(study.campaign.setups):
        for replicate in range(2 if setup < 3 else 1):
            for name, variant in variants(study).items():
                needed = NEEDED.get(name, 200 * WORSE.get(name, 1.0))
                own = np.exp((setup > 0) * 0.1 * random.normal())
                for iterations in (*lengths(variant, setup), *variant.until_reached):
                    noise = np.exp(0.01 * random.normal(size=2))
                    shares = LEFT * own * needed / iterations * noise
                    cells = {"setup": setup, "replicate": replicate, "variant": name, "settled": 1}
                    named = zip((f"{kind}_share" for kind in KINDS), shares, strict=True)
                    rows.append(cells | {"iterations": iterations} | dict(named))
    return pd.DataFrame(rows)


def history(iterations: list[int], seeds: int, learner: str) -> pd.DataFrame:
    """Errors that fall as 1 / iteration, sooner if the learner is the improved one."""
    soon, rows = 5 if learner == IMPROVED else 400, []
    for seed in range(seeds):
        for iteration in iterations:
            errors = INITIAL * (1 + 0.05 * seed) / (1 + iteration / soon)
            keys = {"iterations": iterations[-1], "seed": seed, "iteration": iteration}
            rows.append(keys | dict(zip(ERRORS, errors, strict=True)))
    return pd.DataFrame(rows)


def ends(rows: pd.DataFrame, error: str) -> pd.DataFrame:
    """With an interval of 10 % about an error."""
    return rows.assign(**{f"{error}_low": 0.9 * rows[error], f"{error}_high": 1.1 * rows[error]})


def tables(study: Study) -> Iterator[tuple[str, pd.DataFrame]]:
    """Every table with its path."""
    random = np.random.default_rng(1)
    for place, learners in places(study).items():
        for learner, every in learners.items():
            histories = []
            for length in every:
                often = throughout(study, place, learner, length)
                moments = study.training.during(length) if often else [0, length]
                histories.append(history(moments, study.training.seeds, learner))
            yield place.history_file(RESULTS, learner), pd.concat(histories)
    yield f"{CAMPAIGN}/outcomes.csv", outcomes(study)
    own = random.uniform(0.02, 0.2, (study.campaign.setups, 2))
    untrained = pd.DataFrame(own, columns=KINDS).assign(**dict(zip(ERRORS, INITIAL, strict=True)))
    yield f"{CAMPAIGN}/untrained.csv", untrained.rename_axis("setup").reset_index()
    assignments = pd.DataFrame(random.uniform(1, 12, (500, 2)), columns=ERRORS)
    published = study.paper_damage.published
    assignments.loc[7] = published.position_error_cm, published.orientation_error_deg
    distance = (assignments - assignments.loc[7]).abs().max(axis=1)
    yield f"{RESULTS}/assignments/{study.robot}.parquet", assignments.assign(distance=distance)
    scales = np.repeat([0.1, 1.0, 3.0], 4)
    ensemble = {"scale": scales}
    for error, value in zip(ERRORS, INITIAL, strict=True):
        errors = scales * value * np.tile([0.8, 1, 1.1, 1.3], 3)
        ensemble |= {f"initial_{error}": errors, f"final_{error}": errors * LEFT}
    yield f"{RESULTS}/ensemble.parquet", pd.DataFrame(ensemble)
    balls = pd.MultiIndex.from_product(
        [["theta", "jacobian"], ["intact", "damaged"], [0.1, 1.0, 10.0], range(3)],
        names=["kind", "start", "scale", "ball"],
    )
    propagation = balls.to_frame(index=False)
    updated = np.clip(0.02 * propagation["scale"], 0, 0.9)
    errors = {"classic": 1.0, "updated": updated, "to_original": updated, "to_constant": 1.0}
    yield f"{RESULTS}/mapping/propagation.parquet", propagation.assign(**errors)
    visits = pd.DataFrame({"distance": np.linspace(0, 1, 9), "width": 0.2, "error": 0.001})
    visits["ratio"] = np.minimum(1, 0.5 + visits["distance"])
    yield f"{RESULTS}/mapping/visits.parquet", visits
    budgets = [1, 10, 100, 1000]
    benchmark = pd.MultiIndex.from_product(
        [study.benchmark.scenarios, [*study.benchmark.papers, *study.benchmark.learners], budgets],
        names=["scenario", "learner", "moves"],
    ).to_frame(index=False)
    order = benchmark["learner"].factorize()[0]
    benchmark = benchmark.assign(position_error_cm=8 / benchmark["moves"] ** (0.1 * order))
    yield f"{RESULTS}/benchmark.csv", ends(benchmark, "position_error_cm")
    real = pd.MultiIndex.from_product(
        [[*study.real.learners, *study.real.twin], [5, 50, 1000]], names=["learner", "poses"]
    ).to_frame(index=False)
    order = real["learner"].factorize()[0]
    real["twin"] = real["learner"].isin([*study.real.twin])
    real["position_error_mm"] = 2.5 / real["poses"] ** (0.05 * order)
    real = ends(real, "position_error_mm")
    once = real["learner"] == UNCORRECTED
    real.loc[once, ["position_error_mm_low", "position_error_mm_high"]] = np.nan
    yield f"{RESULTS}/real.csv", real


@pytest.fixture(scope="session")
def small() -> Study:
    """The shipped study with fewer seeds, setups and poses."""
    changes = {"training": {"seeds": 3}, "campaign": {"setups": 20}}
    return read_study(ROOT / "config.yaml", changes)


@pytest.fixture(scope="session")
def project(small, tmp_path_factory) -> Callable[..., Path]:
    """Makes a folder of results of the small study."""

    def make(change: Callable[[pd.DataFrame], pd.DataFrame] = lambda table: table) -> Path:
        folder = tmp_path_factory.mktemp("project")
        for path, table in tables(small):
            write(folder / path, change(table))
        shutil.copy(ROOT / DESIGN, folder / DESIGN)
        write(folder / RESULTS / "claims.json", written(judge(Evidence(small, folder))))
        return folder

    return make


@pytest.fixture(scope="session")
def evidence(small, project) -> Evidence:
    return Evidence(small, project())


@pytest.fixture(scope="session")
def figures(evidence):
    """All, drawn and laid out."""
    found = {}
    with plt.rc_context(STYLE):
        for figure in Figure:
            found[figure] = drawn(figure, evidence)
            found[figure].draw_without_rendering()
    yield found
    plt.close("all")
