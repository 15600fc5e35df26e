"""A study's synthetic results: all that its evidence reads, in files, in a second.

As they are, they support every claim. Tests change what they are about.
"""

import json
import shutil
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from itertools import product
from pathlib import Path
from typing import Self
from unittest import mock

import numpy as np
import pandas as pd

from recalib.numerics.randomness import generator
from replication.config import lengths
from replication.config.shipped import (
    DESIGN,
    DEVIATIONS,
    EFFORTS,
    FACTORS,
    PIECES,
    POWER,
    REFERENCE,
    pieces,
)
from replication.config.study import Study
from replication.config.switches import SWITCHES
from replication.judgement import effects, hierarchy, intervals
from replication.judgement.benchmark import errors, reached
from replication.judgement.claims import CLAIMS, judge, judging
from replication.training.measured import ERRORS
from replication.judgement.needs import Request
from replication.judgement.results import Evidence
from replication.judgement.summary import summarise
from replication.mapping.quantisation import ITERATIONS
from replication.pages.real_arm import real_errors
from replication.plots.registry import FIGURES
from replication.training.samples import sample_of, sought
from replication.training.trainings import Trainings, searches, training

ROOT = Path(__file__).parents[1]
INITIAL = np.array([8.3, 4.7])
AT_FIRST = {"intact": INITIAL * 0, "translation": INITIAL * [1, 0]}
FINAL = {
    "ritter_200": [5.0, 3.0],
    ("improved", "intact"): 1e-9,
    ("improved", "translation"): [0.1, 1e-9],
    **{switch.without: 0.4 for switch in SWITCHES},
    **{switch.added: [4.0, 2.0] for switch in SWITCHES},
}
LADDERS = {"improved": 20, "ritter": 1400, "ritter_double": 1400}  # error times iterations
# Spread of errors: of searches at 0.05 to 0.1 in the experiments, of seeds at 0.05
OF_SEARCHES, OF_SEEDS = 0.07, 0.05
NOISE = 1e-9  # relative: more than machines differ by
UNMEASURED = "scale", "width", "distance"  # but of assignments
SHIPPED = DESIGN, POWER, DEVIATIONS, FACTORS  # used as they are
REPLICATES = 8  # of the reference study
# Spread of logarithms of what the campaign measures: of replicates, and of setups
LUCK, OWN = 0.1, 0.05


def evidence_of(figure: str, results: "Synthetic") -> Evidence:
    """What a figure may read."""
    return results.request().read(FIGURES[figure].needs).evidence


class Noted(dict):
    """Notes which of its entries are read."""

    def __init__(self, its: Mapping):
        super().__init__(its)
        self.read: set[str] = set()

    def __getitem__(self, name: str):
        self.read.add(name)
        return super().__getitem__(name)


def unread(evidence: Evidence, use: Callable[[Evidence], object]) -> set[str]:
    """What was declared and is not used."""
    noted = {kind: Noted(getattr(evidence, kind)) for kind in ("files", "facts")}
    use(evidence.model_copy(update=noted))
    return {name for its in noted.values() for name in its.keys() - its.read}


def without_one(evidence: Evidence) -> Iterator[tuple[str, Evidence]]:
    """Each thing that was declared, and what is left without it."""
    for kind in ("files", "facts"):
        its = getattr(evidence, kind)
        for name in its:
            left = type(its)({other: value for other, value in its.items() if other != name})
            yield name, evidence.model_copy(update={kind: left})


@contextmanager
def few_resamples() -> Iterator[None]:
    """A tenth of them: where intervals have to be there, and that is all."""
    with (
        mock.patch.object(intervals, "RESAMPLES", 2000),
        mock.patch.object(hierarchy, "DRAWS", 128),
        mock.patch.object(hierarchy, "HALVINGS", 30),
        mock.patch.object(effects, "RESAMPLES", 200),
    ):
        yield


class Synthetic:
    """Results of a study in a folder of their own.

    Args:
        folder: of the project that they are made up for.
        study: whose results they are.
        final: what differs from `FINAL`: final errors by learner, or by (learner, scenario).
        noise: relative, of everything measured.
    """

    def __init__(self, folder: Path, study: Study, final=None, noise: float = 0.0):
        self.study, self.trainings, self.folder = study, Trainings(study), folder
        self._final, self._noise = FINAL | (final or {}), noise
        self._tables: dict[str, Callable[[], pd.DataFrame]] = {
            f"assignments/{study.robot}.parquet": self.assignments,
            REFERENCE: self.reference,
            EFFORTS: self.efforts,
        }
        for make in (
            *(self.coupling, self.nearness, self.propagation, self.quantisation),
            *(self.solutions, self.visits, self.widths, self.replay),
        ):
            self._tables[f"mapping/{make.__name__}.parquet"] = make
        for scenario, learner in self.trainings.runs:
            path = f"runs/{scenario}/{learner}.parquet"
            self._tables[path] = partial(self.history, learner, scenario)
        for learner, series in study.experiments.ensemble.items():
            for name, plan in series.items():
                path = f"ensemble/{name}.{learner}.parquet"
                self._tables[path] = partial(self.ensemble, plan)
        for scenario in self.trainings.scenarios():
            self.scenario(scenario)
        for name in SHIPPED:
            self.path(name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.path(name))

    def path(self, name: str) -> Path:
        """Where a result lies, or what is shipped."""
        return self.folder / (name if name.startswith("workflow/") else f"results/{name}")

    def sample_at(self, name: str) -> str:
        """Where the searches for a training lie, made up when they are asked for."""
        path = self.folder / "search" / f"{name}.csv"
        if not path.exists():
            path.parent.mkdir(exist_ok=True)
            numbers = range(1, searches(self.study, name) + 1)
            trials = pd.concat([_trials(name, number) for number in numbers], ignore_index=True)
            path.write_text(sample_of(sought(self.study, name), trials), encoding="utf-8")
        return str(path)

    def request(self) -> Request:
        """How to ask for these results."""
        return Request(self.study, self.trainings, f"{self.folder}/results", self.sample_at)

    def evidence(self, needs: str) -> Evidence:
        """What something reads of them, made up where it is not there."""
        ask = self.request().read(needs)
        assert ask.lacking == []
        return self.made(ask.evidence)

    def made(self, evidence: Evidence) -> Evidence:
        """Make up what something reads and is not there."""
        for name in evidence.files:
            if name in self._tables and not self.path(name).exists():
                self.write(name, self._tables[name]())
        return evidence

    def write(self, name: str, table: pd.DataFrame) -> None:
        """Keep a table of measurements, with their noise."""
        path = self.path(name)
        rng = np.random.default_rng(zlib.crc32(name.encode()))
        table = table.reset_index(drop=True)
        for column in table.select_dtypes("float") if self._noise else ():
            if column not in UNMEASURED or "assignments" in name:
                signs = rng.choice([-1.0, 1.0], len(table))
                table[column] = table[column] * (1 + self._noise * signs)
        path.parent.mkdir(parents=True, exist_ok=True)
        if name.endswith(".csv"):
            table.to_csv(path, index=False, float_format="%.6g")
        else:
            table.to_parquet(path, index=False)

    def history(self, learner: str, scenario: str) -> pd.DataFrame:
        """A history with luck of searches and of seeds."""
        which = training(self.study, learner)
        fallback = LADDERS[which.name] / which.iterations if which.name in LADDERS else 0.3
        final = self._final.get((learner, scenario), self._final.get(learner, fallback))
        initial = AT_FIRST.get(scenario, INITIAL)
        count, seeds = searches(self.study, learner), self.study.training.seeds
        rng = generator(0, "made up", scenario, learner)
        last = (np.broadcast_to(final, 2) * _luck(rng, count, seeds)).reshape(-1, 2)
        parts = np.array([0, 0.1, 0.4, 1])
        part = parts[:, None, None]
        measured = (initial * (1 - part) + last * part).reshape(-1, 2)
        done = np.repeat(np.rint(which.iterations * parts).astype(int), len(last))
        return pd.DataFrame(
            {
                **dict(zip(ERRORS, measured.T, strict=True)),
                "search": np.tile(np.repeat(np.arange(count) + 1, seeds), len(parts)),
                "seed": np.tile(np.arange(len(last)), len(parts)),
                "iteration": done,
                "moves": 2 * done,
                "refused": 0,
            }
        )

    def reference(self) -> pd.DataFrame:
        """The replicates of the reference study."""
        rng = generator(0, "made up", "reference")
        table = _measured(REPLICATES, 1, {}, rng)
        for system, rate, n in product(("improved", "ritter"), ("linear", "exponential"), (3, 6)):
            table[f"schedule_{system}_{rate}_{n}"] = 0.5 * _spread(rng, REPLICATES)
        for system, length, error in product(("improved", "ritter"), lengths.MAPS, ERRORS):
            for maps, level in (("one", 20), ("two", 10)):
                luck = _spread(rng, REPLICATES)
                table[f"{maps}_{system}_{length}_{error}"] = level / length**0.5 * luck
        return table.assign(universe=-1, replicate=range(REPLICATES))

    def outcomes(self, means: Mapping[str, float] | None = None, repetition=0) -> pd.DataFrame:
        """What the setups measure.

        Args:
            means: over the setups, by column; those that support the claims unless given.
        """
        plan, rng = self.study.universes, generator(repetition, "made up", "outcomes")
        return _measured(plan.count, plan.replicates, means or {}, rng)

    def horizon(self, factor: float = 100.0) -> pd.DataFrame:
        """How long Ritter's takes in the setups."""
        plan, rng = self.study.universes, generator(0, "made up", "horizon")
        table = _numbered(len(plan.horizons), plan.replicates)
        table["universe"] = np.repeat(plan.horizons, plan.replicates)
        return table.assign(factor=factor * _spread(rng, len(table)), bound=0)

    def campaign(self, **tables: pd.DataFrame) -> Self:
        """Keep the tables of the campaign; those that are not given support the claims."""
        for name in PIECES:
            table = tables[name] if name in tables else getattr(self, name)()
            paths = pieces(name, table["universe"].nunique())
            piece = pd.factorize(table["universe"])[0] // PIECES[name]
            for number, path in enumerate(paths):
                self.write(path, table[piece == number])
        return self

    def efforts(self) -> pd.DataFrame:
        """Trainings for the factor of 70: a rough search leaves half as much error again."""
        own, ladder = training(self.study, "improved").iterations, self.study.experiments.ladder
        rungs = {"improved": [own]} | {name: ladder[name] for name in LADDERS if "ritter" in name}
        cases = [(name, iterations) for name, its in rungs.items() for iterations in its]
        tables = []
        for (name, iterations), (effort, worse) in product(cases, (("full", 1.0), ("rough", 1.5))):
            count, seeds = (4 if effort == "full" else 8), self.study.training.seeds
            whens = np.linspace(0.1, 1, 10) if iterations >= lengths.LONG else np.ones(1)
            keys = product(range(count), range(seeds), np.rint(whens * iterations).astype(int))
            table = pd.DataFrame(keys, columns=["search", "seed", "iteration"])
            rng = generator(0, "made up", "efforts", name, iterations, effort)
            luck = np.repeat(_luck(rng, count, seeds).reshape(-1, 2), len(whens), axis=0)
            level = worse * LADDERS[name] / table[["iteration"]].to_numpy()
            table[list(ERRORS)] = level * luck
            about = {"training": f"{name}_{iterations}", "effort": effort, "iterations": iterations}
            tables.append(table.assign(**about))
        return pd.concat(tables, ignore_index=True)

    def quantisation(self) -> pd.DataFrame:
        distances = {"boxes": 0.5, "faces": 0.6, "kmeans": 0.49}
        distances |= {f"kohonen_{count}": 0.55 for count in ITERATIONS}
        cases = product(distances.items(), range(10))
        rows = [(name, seed, its * (1 + 0.001 * seed)) for (name, its), seed in cases]
        return pd.DataFrame(rows, columns=["placement", "seed", "distance"])

    def coupling(self) -> pd.DataFrame:
        rng = np.random.default_rng(1)
        names = np.repeat(self.study.experiments.scenarios, 9)
        columns = {"position": 0.02, "orientation": 0.05}
        return pd.DataFrame(
            {name: level * rng.uniform(0.5, 1.5, len(names)) for name, level in columns.items()}
        ).assign(scenario=names)

    def nearness(self, larger: float = 2.0, nearer: float = 1.5) -> pd.DataFrame:
        """`larger`: what a larger box does to the coupling; `nearer`: what half of its poses do."""
        table = pd.DataFrame(product((1, 2), range(10), range(8)), columns=["size", "draw", "pose"])
        table["condition"] = 5.0 + table.pop("pose")
        near = (table["size"] == 2) & (table["condition"] > 8.5)
        level = 0.05 * (1 + 0.01 * table["draw"])
        table["orientation"] = level * np.where(table["size"] == 2, larger / nearer, 1)
        table["orientation"] *= np.where(near, nearer, 1)
        return table.assign(position=0.01)

    def solutions(self) -> pd.DataFrame:
        return pd.DataFrame({"scenario": "links", "joint_solutions": [7, 8, 8], "commands": 1})

    def widths(self, wide: int = 5, narrow: int = 300) -> pd.DataFrame:
        cases = product({"wide": wide, "narrow": narrow}.items(), range(10))
        rows = [(width, 0.8, seed, its + seed % 2) for (width, its), seed in cases]
        return pd.DataFrame(rows, columns=["width", "rate", "seed", "iterations"])

    def propagation(self, ratio: float = 0.1) -> pd.DataFrame:
        cases = product(("theta", "jacobian"), ("intact", "damaged"), (0.1, 1.0, 10.0), range(3))
        table = pd.DataFrame(cases, columns=["kind", "start", "scale", "ball"])
        table["classic"] = 1 + 0.1 * table["ball"]
        table["updated"] = ratio * table["classic"]
        table["to_constant"], table["to_original"] = 0.9, 0.1
        return table.drop(columns="ball")

    def visits(self) -> pd.DataFrame:
        table = pd.DataFrame(
            product((0.1, 0.2), (0.0, 0.3, 0.6, 1.0)), columns=["width", "distance"]
        )
        near = table["distance"] < 3 * table["width"]
        return table.assign(ratio=np.where(near, 0.5, 1.01), error=0.01)

    def replay(self) -> pd.DataFrame:
        return pd.DataFrame({"array": ["theta"], "difference": [0.0]})

    def assignments(self) -> pd.DataFrame:
        grid = np.linspace(0.5, 2, 41)
        table = pd.DataFrame(grid[:, None] * INITIAL, columns=list(ERRORS))
        return table.assign(distance=np.abs(grid - 1))

    def ensemble(self, plan) -> pd.DataFrame:
        table = pd.DataFrame(product(range(12), plan.scales), columns=["robot", "scale"])
        rng = np.random.default_rng(3)
        for moment, level in (("initial", INITIAL), ("final", 0.05 * INITIAL)):
            for error, value in zip(ERRORS, level, strict=True):
                luck = rng.uniform(0.5, 1.5, len(table))
                table[f"{moment}_{error}"] = value * table["scale"] * luck
        return table

    def scenario(self, scenario: str) -> None:
        damages = {
            "translation": [{"translate": ["5 cm", "-5 cm", "4.3 cm"]}],
            "rotation": [{"rotate": ["2 deg", "-3 deg", "3 deg"]}],
        }.get(scenario, [{"link": "forearm_link", "shorten": "4 cm"}])
        initial = AT_FIRST.get(scenario, INITIAL)
        described = {
            "scenario": scenario,
            "robot": scenario.partition("-")[2] or self.study.robot,
            "damages": damages,
            **{f"initial_{error}": value for error, value in zip(ERRORS, initial, strict=True)},
        }
        path = self.path(f"scenarios/{scenario}.json")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(described), encoding="utf-8")

    @few_resamples()
    def judge(self) -> list[dict]:
        """The claims, judged by these results."""
        claims = judging(self.request)
        for evidence in claims.values():
            self.made(evidence)
        return judge(claims)

    @few_resamples()
    def judged(self, claim: str) -> dict:
        """One claim, judged by these results, of which it may lack some."""
        home = next(its for its in CLAIMS if its.id == claim)
        return home.judge(self.made(self.request().read(home.all_needs).evidence))

    def verdict(self, claim: str) -> str:
        """The verdict on one claim."""
        return self.judged(claim)["verdict"]

    @few_resamples()
    def conclude(self) -> None:
        """Make the tables and verdicts that figures and pages read, as the workflow does."""
        self.campaign()
        for path, table in self._tables.items():
            self.write(path, table())
        runs, seed = self.trainings.runs, self.study.seed
        histories = [self.path(f"runs/{on}/{learner}.parquet") for on, learner in runs]
        scenarios = [self.path(f"scenarios/{name}.json") for name in self.trainings.scenarios()]
        self.write("summary.csv", summarise(histories, scenarios, runs, seed))
        self.compare()
        self.write("real.csv", real_errors(self.real(), seed))
        self.path("claims.json").write_text(json.dumps(self.judge()), encoding="utf-8")

    def compare(self) -> None:
        """Make the tables of the benchmark."""
        plan = self.study.benchmark
        history = self.benchmark(), plan.scenarios, plan.learners
        self.write("benchmark.csv", errors(*history, self.study.seed))
        self.write("benchmark_moves.csv", reached(*history, plan.thresholds))

    def benchmark(self) -> pd.DataFrame:
        plan, rng = self.study.benchmark, np.random.default_rng(5)
        cases = product(plan.scenarios, plan.learners, (1, 4, 32, 400), range(4))
        table = pd.DataFrame(cases, columns=["scenario", "learner", "moves", "seed"])
        for error, level in zip(ERRORS, INITIAL, strict=True):
            luck = rng.uniform(0.5, 1.5, len(table)) * (1 + self._noise * rng.choice([-1, 1]))
            table[error] = level * luck * table["learner"].str.len() / table["moves"]
        return table

    def real(self) -> pd.DataFrame:
        plan, rng = self.study.real, np.random.default_rng(6)
        learners = [*plan.learners, *(f"{learner} on a twin" for learner in plan.twin)]
        cases = product(learners, plan.poses, range(3))
        table = pd.DataFrame(cases, columns=["learner", "poses", "subset"])
        luck = rng.uniform(0.5, 1.5, len(table)) * (1 + self._noise * rng.choice([-1, 1]))
        return table.assign(position_error_mm=2 * luck / np.sqrt(table["poses"]))


def _numbered(setups: int, replicates: int) -> pd.DataFrame:
    keys = product(range(setups), range(replicates))
    return pd.DataFrame(keys, columns=["universe", "replicate"])


def _luck(rng: np.random.Generator, searches: int, seeds: int) -> np.ndarray:
    """Factors (search, seed, 2) of errors."""
    of_searches = OF_SEARCHES * rng.normal(size=(searches, 1, 2))
    return np.exp(of_searches + OF_SEEDS * rng.normal(size=(searches, seeds, 2)))


def _spread(rng: np.random.Generator, count: int, spread: float = LUCK) -> np.ndarray:
    return np.exp(spread * rng.normal(size=count))


def _measured(
    setups: int, replicates: int, means: Mapping[str, float], rng: np.random.Generator
) -> pd.DataFrame:
    """What replicates of setups measure for each claim, with heterogeneity and luck."""
    table = _numbered(setups, replicates)
    for moment, level in (("initial", INITIAL), ("final", 0.02 * INITIAL)):
        for error, value in zip(ERRORS, level, strict=True):
            table[f"{moment}_{error}"] = value * _spread(rng, len(table))
    table["rigid"] = 0.01 * _spread(rng, len(table))
    for across in {its.column: its for claim in CLAIMS for its in claim.across.values()}.values():
        if across.table == "outcomes":
            limit, below = across.comparison.limit, across.comparison.below
            mean = means.get(across.column, limit * (0.5 if below else 2.0) or 0.4)
            own = np.repeat(OWN * rng.normal(size=setups), replicates)
            moved = own + LUCK * rng.normal(size=len(table))
            table[across.column] = mean * np.exp(moved) if across.logarithmic else mean + moved
    return table


def _trials(learner: str, search: int) -> pd.DataFrame:
    """A hundred trials, of which thirty are good."""
    rng, good = np.random.default_rng(search), np.arange(100) < 30
    maps = ("position", "orientation") if "improved" in learner else ("pose",)
    table = pd.DataFrame({"round": 1, "initial_width": 1.0}, index=range(100))
    for name, net in product(maps, ("g_k", "g_kl")):
        wanted = (name, net) in (("position", "g_k"), ("orientation", "g_kl"))
        widths = np.where(good, 0.3, 1) * rng.lognormal(0, 0.1, 100) if wanted else 1.0
        table[f"{name}/{net}"] = widths
    table["initial_rate"], table["final_rate"] = 0.8, 0.4
    table[ERRORS[0]] = np.where(good, 0.3, 3.0) * rng.uniform(1, 1.5, 100)
    table[ERRORS[1]], table["score"] = 0.1, table[ERRORS[0]]
    table = table.map(lambda value: float(f"{value:.4g}"))
    table.insert(0, "search", search)
    return table
