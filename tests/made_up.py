"""A study's results made up: all that its evidence reads, in files, in a second.

As they are, they support every claim. Tests change what they are about.
"""

import json
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd

from recalib.study import jobs
from recalib.study.configuration.study import Study
from recalib.study.configuration.switches import SWITCHES
from recalib.study.evidence.benchmark import errors, reached
from recalib.study.evidence.claims import CLAIMS, judge, judging
from recalib.study.evidence.needs import Request
from recalib.study.evidence.real import real_errors
from recalib.study.evidence.results import Evidence
from recalib.study.evidence.summary import summarise
from recalib.study.experiments.samples import write_sample
from recalib.study.layout import Layout
from recalib.study.measured import ERRORS
from recalib.study.plan import Plan
from recalib.study.trainings import Trainings, training

SEEDS = 8
INITIAL = np.array([8.3, 4.7])
AT_FIRST = {"intact": INITIAL * 0, "translation": INITIAL * [1, 0]}
FINAL = {
    "improved": 0.1,
    "ritter": 0.12,
    "ritter_200": [5.0, 3.0],
    ("improved", "intact"): 1e-9,
    ("improved", "translation"): [0.1, 1e-9],
    **{switch.without: 0.4 for switch in SWITCHES},
    **{switch.added: [4.0, 2.0] for switch in SWITCHES},
    "ritter_double": 0.3,
}
LADDERS = {"improved": 20.0, "ritter": 1200.0}  # error times iterations


class MadeUp:
    """Results of a study in a folder of their own.

    Args:
        folder: of the project that they are made up for.
        study: whose results they are.
        final: what differs from `FINAL`: final errors by learner, or by (learner, scenario).
        noise: relative, of everything measured.
    """

    def __init__(self, folder: Path, study: Study, final=None, noise: float = 0.0):
        self.study, self.trainings = study, Trainings(study)
        self.layout = Layout(str(folder / "results"))
        self._final, self._noise = FINAL | (final or {}), noise
        self._samples = folder / "search"
        for name in ("coupling", "propagation", "visits", "replay"):
            self.write(self.layout.mapping(name), getattr(self, name)())
        self.write(self.layout.assignments(study.robot), self.assignments())
        for scenario, learner in self.trainings.runs:
            self.write(self.layout.history(scenario, learner), self.history(learner, scenario))
        for learner, series in study.experiments.ensemble.items():
            for name, plan in series.items():
                self.write(self.layout.ensemble(name, learner), self.ensemble(plan))
        for learner in dict.fromkeys(learner for _, learner in self.trainings.runs):
            self.sample(learner)
        for scenario in self.trainings.scenarios():
            self.scenario(scenario)

    def sample_at(self, name: str) -> str:
        """Where the sample of the search for a training lies."""
        return str(self._samples / f"{name}.csv")

    def request(self) -> Request:
        """How to ask for these results."""
        return Request(self.study, self.trainings, self.layout, self.sample_at)

    def needs(self, ask_for):
        """What something reads of them."""
        ask = self.request()
        ask_for(ask)
        assert ask.lacking == []
        return ask.needs

    def write(self, path: str, table: pd.DataFrame) -> None:
        """Keep a table of measurements, with their noise."""
        rng = np.random.default_rng(len(path))
        table = table.reset_index(drop=True)
        for column in table.select_dtypes("float"):
            if column not in ("scale", "width", "distance") or "assignments" in path:
                signs = rng.choice([-1.0, 1.0], len(table))
                table[column] = table[column] * (1 + self._noise * signs)
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        table.to_parquet(path, index=False)

    def history(self, learner: str, scenario: str) -> pd.DataFrame:
        which = training(self.study, learner)
        rung = LADDERS.get(which.name, 0) / which.iterations
        fallback = (learner == str(which) and rung) or 0.3
        final = self._final.get((learner, scenario), self._final.get(learner, fallback))
        initial = AT_FIRST.get(scenario, INITIAL)
        rng = np.random.default_rng(len(learner))
        last = np.broadcast_to(final, 2) * np.exp(0.02 * rng.normal(size=(SEEDS, 2)))
        tables = []
        for part in (0, 0.1, 0.4, 1):
            measured = initial * (1 - part) + last * part
            table = pd.DataFrame(measured, columns=list(ERRORS))
            done = round(which.iterations * part)
            tables.append(
                table.assign(seed=range(SEEDS), iteration=done, moves=2 * done, refused=0)
            )
        return pd.concat(tables)

    def coupling(self) -> pd.DataFrame:
        rng = np.random.default_rng(1)
        names = np.repeat(self.study.experiments.scenarios, 9)
        columns = {"position": 0.02, "orientation": 0.05}
        return pd.DataFrame(
            {name: level * rng.uniform(0.5, 1.5, len(names)) for name, level in columns.items()}
        ).assign(scenario=names)

    def propagation(self, ratio: float = 0.1) -> pd.DataFrame:
        cases = product(("theta", "jacobian"), ("intact", "damaged"), (0.1, 1.0, 10.0), range(3))
        table = pd.DataFrame(cases, columns=["kind", "start", "scale", "ball"])
        table["classic"] = 1 + 0.1 * table["ball"]
        table["updated"] = ratio * table["classic"]
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

    def trials(self, learner: str) -> pd.DataFrame:
        rng, good = np.random.default_rng(0), np.arange(100) < 30
        maps = ("position", "orientation") if "improved" in learner else ("pose",)
        narrow = {"position": "g_k", "orientation": "g_kl"}
        table = pd.DataFrame({"round": 1, "initial_width": 1.0}, index=range(100))
        for name, net in product(maps, ("g_k", "g_kl")):
            wanted = narrow.get(name) == net
            table[f"{name}/{net}"] = (
                np.where(good, 0.3, 1) * rng.lognormal(0, 0.1, 100) if wanted else 1.0
            )
        table["initial_rate"], table["final_rate"] = 0.8, 0.4
        table[ERRORS[0]] = np.where(good, 0.3, 3.0) * rng.uniform(1, 1.5, 100)
        return table.assign(**{ERRORS[1]: 0.1}).map(lambda value: float(f"{value:.4g}"))

    def sample(self, learner: str, trials: pd.DataFrame | None = None) -> None:
        path = self.sample_at(str(training(self.study, learner)))
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        its = self.trials(learner) if trials is None else trials
        write_sample(path, Plan(self.study).sample(learner), its)

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
        path = Path(self.layout.scenario(scenario))
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(described), encoding="utf-8")

    def judge(self) -> list[dict]:
        """The claims, judged by these results."""
        return judge(judging(self.request))

    def verdict(self, claim: str) -> str:
        """The verdict on one claim."""
        home = next(each for each in CLAIMS if each.id == claim)
        return home.judge(Evidence(self.needs(home.needs)))["verdict"]

    def conclude(self) -> None:
        """Make the tables and verdicts that figures and pages read, as the workflow does."""
        layout, plan = self.layout, Plan(self.study)
        histories = [layout.history(*run) for run in self.trainings.runs]
        scenarios = [layout.scenario(name) for name in self.trainings.scenarios()]
        tables = {layout.summary: summarise(plan.summary(), histories, scenarios)}
        history = self.benchmark()
        tables[layout.benchmark] = errors(plan.benchmark_table(), history)
        tables[layout.benchmark_moves] = reached(plan.benchmark_table(), history)
        tables[layout.real] = real_errors(jobs.RealTable(seed=self.study.seed), self.real())
        for path, table in tables.items():
            table.to_csv(path, index=False, float_format="%.6g")
        Path(layout.claims).write_text(json.dumps(self.judge()), encoding="utf-8")

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
