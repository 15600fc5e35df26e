"""The verdicts follow from the numbers: every claim is judged on evidence made up to support it, and to contradict it."""

import copy
import json

import numpy as np
import pandas as pd
import pytest
import yaml

from recalib.study.evidence.claims import MEASURES, judge
from recalib.study.evidence.pages import measured
from recalib.study.evidence.results import ERRORS, Evidence
from tests.conftest import ROOT

CRITERIA = yaml.safe_load((ROOT / "workflow" / "criteria.yaml").read_text())
SEEDS = 20
INITIAL = np.array([8.3, 4.7])


class MadeUp(Evidence):
    """Evidence whose final errors are given for each learner and scenario."""

    def __init__(self, config, final, studies, trials):
        super().__init__(config)
        self.final, self.studies, self.sample = final, studies, trials

    def history(self, learner, scenario=None):
        scenario = scenario or self.paper
        final = np.broadcast_to(
            self.final.get((learner, scenario), self.final.get(learner, 0.3)), 2
        )
        initial = {"intact": np.zeros(2), "translation": INITIAL * [1, 0]}.get(scenario, INITIAL)
        noise = np.exp(0.02 * np.random.default_rng(len(learner)).normal(size=(SEEDS, 2)))
        frames = [
            pd.DataFrame(errors, columns=ERRORS).assign(seed=range(SEEDS), iteration=iteration)
            for iteration, errors in ((0, np.tile(initial, (SEEDS, 1))), (200, final * noise))
        ]
        return pd.concat(frames)

    def study(self, name):
        return self.studies[name]

    def trials(self, training):
        return self.sample

    def assignments(self):
        grid = np.linspace(0.5, 2, 41)
        table = pd.DataFrame({ERRORS[0]: 8.3 * grid, ERRORS[1]: 4.7 * grid})
        return table.assign(distance=np.abs(grid - 1))


def propagation(ratio):
    rows = [
        {"kind": kind, "start": start, "scale": scale, "classic": 1.0, "updated": ratio}
        for kind in ("theta", "jacobian")
        for start in ("intact", "damaged")
        for scale in (1, 10)
    ]
    return pd.DataFrame(rows)


def supporting(config):
    final = {
        "improved": 0.25,
        "ritter_200": [5.0, 3.0],
        "ritter": 0.3,
        ("improved", "intact"): 1e-9,
        ("improved", "translation"): [0.1, 1e-9],
        ("improved", "rotation"): 0.1,
        ("improved", "translation_rotation"): 0.1,
    }
    final |= {learner: 0.4 for learner in config["learners"] if learner.startswith("improved_")}
    final |= {
        learner: [4.0, 2.0] for learner in config["learners"] if learner.startswith("ritter_")
    } | {"ritter_double": 0.3}
    ladder = {"improved": 1 / 3, "ritter": 20.0}
    final |= {
        f"{name}_{rung}": 60 / rung * scale * np.ones(2)
        for name, scale in ladder.items()
        for rung in config["experiments"]["ladder"][name]
    }
    final |= {"improved": 0.1, "ritter": 20 * 60 / 10_000, "ritter_200": [5.0, 3.0]}
    studies = {
        "coupling": pd.DataFrame(
            {"position": [0.02] * 9, "orientation": [0.05] * 9, "scenario": ["links"] * 9}
        ),
        "propagation": propagation(0.1),
        "visits": pd.DataFrame(
            {
                "width": [0.1, 0.1],
                "distance": [0.0, 0.5],
                "ratio": [0.5, 1.01],
                "error": [0.01, 0.01],
            }
        ),
        "replay": pd.DataFrame({"array": ["theta"], "difference": [0.0]}),
    }
    rng = np.random.default_rng(0)
    good = np.arange(100) < 30
    trials = pd.DataFrame(
        {
            "round": 1,
            "position/g_k": np.where(good, 0.3, 1) * rng.lognormal(0, 0.1, 100),
            "position/g_kl": 1.0,
            "orientation/g_k": 1.0,
            "orientation/g_kl": np.where(good, 0.3, 1) * rng.lognormal(0, 0.1, 100),
            ERRORS[0]: np.where(good, 0.3, 3.0) * rng.uniform(1, 1.5, 100),
            ERRORS[1]: 0.1,
        }
    )
    return MadeUp(config, final, studies, trials)


@pytest.fixture(scope="module")
def evidence(config):
    return supporting(config)


def verdicts(evidence):
    return {claim["id"]: claim["verdict"] for claim in judge(CRITERIA, evidence)}


def test_every_claim_has_a_criterion_with_a_reason_and_a_measure():
    assert [claim["id"] for claim in CRITERIA] == list(MEASURES)
    assert all(claim["criterion"] and claim["reason"] and claim["limits"] for claim in CRITERIA)


def test_supporting_evidence_supports_every_claim(evidence):
    assert verdicts(evidence) == dict.fromkeys(MEASURES, "supported")


def test_the_contract_of_claims_json_holds(evidence):
    for claim in json.loads(json.dumps(judge(CRITERIA, evidence), allow_nan=False)):
        keys = [
            "id",
            "section",
            "statement",
            "published",
            "measured",
            "interval",
            "criterion",
            "verdict",
            "note",
        ]
        assert list(claim) == keys and claim["measured"] and measured(claim)
        assert set(claim["interval"]) <= set(claim["measured"])


def against(evidence, **changes):
    other = copy.copy(evidence)
    for key, value in changes.items():
        setattr(other, key, getattr(evidence, key) | value if isinstance(value, dict) else value)
    return verdicts(other)


@pytest.mark.parametrize(
    ("claim", "final"),
    [
        ("identity", {("improved", "intact"): [0.002, 0]}),
        ("ritter-slow", {"ritter_200": [1.0, 3.0]}),
        ("figure-1", {"improved": 1.0}),
        ("separate-maps", {"improved_single_map": 0.1}),
        ("separate-maps", {"ritter_separate_maps": [5.0, 3.0]}),
        ("theta-increments", {"improved_theta_values": 0.1}),
        ("jacobian-increments", {"ritter_jacobian_increments": [5.0, 3.0]}),
        ("schedule", {"improved_exponential": 0.1}),
        ("rigid", {("improved", "rotation"): [0.5, 0.1]}),
        ("rigid", {("improved", "translation"): [0.1, 0.02]}),
        ("speed-up", {"ritter_2000": 0.05}),
    ],
)
def test_contradicting_errors_change_the_verdict(evidence, claim, final):
    assert against(evidence, final=final)[claim] == "not supported"


@pytest.mark.parametrize(
    ("claim", "studies"),
    [
        (
            "weak-coupling",
            {
                "coupling": pd.DataFrame(
                    {"position": [0.2], "orientation": [0.0], "scenario": ["links"]}
                )
            },
        ),
        ("theta-increments", {"propagation": propagation(1.2)}),
        ("jacobian-increments", {"propagation": propagation(1.0)}),
        (
            "expected-learning",
            {
                "visits": pd.DataFrame(
                    {"width": [0.1], "distance": [1.0], "ratio": [1.2], "error": [0.1]}
                )
            },
        ),
        ("controller-kept", {"replay": pd.DataFrame({"array": ["theta"], "difference": [1e-9]})}),
    ],
)
def test_contradicting_studies_change_the_verdict(evidence, claim, studies):
    assert against(evidence, studies=studies)[claim] == "not supported"


def test_contradicting_trials_change_the_verdict(evidence):
    swapped = evidence.sample.rename(
        columns={"position/g_k": "position/g_kl", "position/g_kl": "position/g_k"}
    )
    assert against(evidence, sample=swapped)["width-order"] == "not supported"
    lucky = evidence.sample.assign(**{ERRORS[0]: [0.01, *[3.0] * 99], ERRORS[1]: 0.01})
    assert against(evidence, sample=lucky)["rough-search"] == "not supported"


def test_unusual_initial_errors_change_the_verdict(evidence):
    assert against(evidence, published={ERRORS[0]: 30.0})["initial-error"] == "not supported"
