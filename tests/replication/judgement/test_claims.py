"""Verdicts follow from the numbers: judged in worlds that support each claim, or contradict it."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from replication.campaign import TWO_MAPS, lengths
from replication.campaign.variants import variants
from replication.judgement import Evidence, Verdict, read_findings, written
from replication.judgement.claims import OfSetups, claims, judge
from replication.running import write
from replication.training import ERRORS, KINDS
from tests.conftest import ROOT, changed

SETUPS, OWN, NOISE = 24, 0.05, 0.01
BEST, LEFT = np.log(0.03), np.log(0.5)  # shares that the improved system and Ritter's map leave
WORSE = 0.5  # of a logarithm: by which what the paper calls worse is

# Of the variants that the paper holds to be worse than others, on the logarithmic scale.
PAPER = {
    "improved_single_map": WORSE,
    "improved_theta_values": WORSE,
    "improved_jacobian_values": WORSE,
    "ritter_theta_increments": -WORSE,
    "ritter_jacobian_increments": -WORSE,
    "improved_exponential": WORSE,
    "improved_values": 2 * WORSE,
    "improved_values_drastic": WORSE,
    "radial_values": WORSE,
    "two_maps_for_position_wide": WORSE,
    "two_maps_for_position_reverse": WORSE,
    "two_maps_for_orientation_reverse": WORSE,
    "small_subnet_for_position": WORSE,
    "small_supernet_for_orientation": WORSE,
    TWO_MAPS: -WORSE,
    "one_map_for_position": -WORSE,
    "one_map_for_orientation": -WORSE,
}


def world(study, paper: bool) -> pd.DataFrame:
    """A campaign in which all is as the paper says, or just the other way round."""
    rng, rows, sign = np.random.default_rng(5), [], 1 if paper else -1
    for setup in range(SETUPS):
        own = OWN * rng.normal(size=100)
        for replicate in range(2 if setup < 3 else 1):
            for number, (name, variant) in enumerate(variants(study).items()):
                for iterations in (*lengths(variant, setup), *variant.until_reached):
                    log = _log(study, variant, iterations, paper)
                    log += sign * PAPER.get(name, 0.0) + own[number] + NOISE * rng.normal()
                    keys = {"setup": setup, "replicate": replicate, "variant": name}
                    shares = dict.fromkeys((f"{kind}_share" for kind in KINDS), np.exp(log))
                    rows.append(keys | {"iterations": iterations, "settled": 1} | shares)
    return pd.DataFrame(rows)


def _log(study, variant, iterations, paper) -> float:
    """The logarithm of the share that is left, before who is better and who is worse."""
    longer = np.log(iterations / study.experiments.iterations)
    if variant.improved:
        return (BEST if paper else LEFT) - 0.5 * longer
    if paper:  # it gets there after 70 times as many iterations
        return LEFT - (LEFT - BEST) * longer / np.log(70)
    return np.log(0.05)  # it is there at once


@pytest.fixture(scope="module")
def judged(study, tmp_path_factory):
    def found(paper: bool):
        folder = tmp_path_factory.mktemp("campaign")
        write(folder / "workflow/campaign/outcomes.csv", world(study, paper))
        design = pd.read_csv(ROOT / "workflow/campaign/design.csv")
        write(folder / "workflow/campaign/design.csv", design)
        table = pd.DataFrame({"setup": range(30)})
        for number, kind in enumerate(KINDS):  # of the published size, and spread by a third
            spread = np.exp(0.1 * np.random.default_rng(number).normal(size=30))
            table[kind] = (0.05 if paper else 0.5) * spread
            table[ERRORS[number]] = (8.3, 4.7)[number] * spread * (1 if paper else 3)
        write(folder / "workflow/campaign/untrained.csv", table)
        grid = pd.DataFrame({error: [8.3, 4.7] for error in ERRORS}).assign(distance=[0.0, 1.0])
        write(folder / f"results/assignments/{study.robot}.parquet", grid)
        last, off = study.experiments.iterations, [0.0, 1e-4 if paper else 1e-2]
        intact = {"iterations": last, "seed": 0, "iteration": [0, last]}
        intact = pd.DataFrame(intact | dict.fromkeys(ERRORS, off))
        for learner in ("improved", "ritter"):
            write(folder / f"results/runs/{study.robot}/intact/{learner}.parquet", intact)
        findings = judge(Evidence(study, folder))
        write(folder / "claims.json", written(findings))
        return read_findings(Path(folder / "claims.json"))

    return {paper: found(paper) for paper in (True, False)}


OF_SETUPS = "ritter-slow large-neighbourhoods no-good-solution separate-maps widths-position"
OF_SETUPS += " widths-orientation cells-position cells-orientation theta-increments not-drastic"
OF_SETUPS += " jacobian-increments cooperation schedule figure-1 long rough-search local-units"
OTHERS = "weak-coupling", "initial-error", "speed-up", "identity"  # by other tables, too


def test_every_claim_says_all_of_itself_and_those_of_setups_are_tried(study):
    tried = {claim.id for claim in claims(study) if isinstance(claim, OfSetups)}
    assert tried == {*OF_SETUPS.split()}
    statements = claims(study)
    assert len({statement.id for statement in statements}) == len(statements)
    for statement in statements:
        for field in ("words", "claim", "criterion", "reason", "section"):
            assert getattr(statement, field), (statement.id, field)


@pytest.mark.parametrize("name", [*OF_SETUPS.split(), *OTHERS])
def test_a_world_as_the_papers_supports_a_claim(judged, name):
    assert judged[True][name].verdict is Verdict.SUPPORTED


@pytest.mark.parametrize("name", [*OF_SETUPS.split(), *OTHERS])
def test_a_world_of_the_opposite_contradicts_it(judged, name):
    assert judged[False][name].verdict is Verdict.CONTRADICTED


def test_a_finding_has_mean_another_setup_heterogeneity_and_luck(judged):
    finding = judged[True]["theta-increments"]
    number, spread = finding.estimates[0], finding.spread
    assert number.value == pytest.approx(np.exp(-WORSE), rel=0.05)
    assert number.interval[0] < number.value < number.interval[1]
    assert number.predictive_interval[0] < number.interval[0]
    assert spread.setups == SETUPS and spread.unsettled == 0
    assert spread.luck_interval[0] < np.sqrt(2) * NOISE < spread.luck_interval[1]
    assert spread.between_interval[0] < np.sqrt(2) * OWN < spread.between_interval[1]
    assert spread.shares[Verdict.SUPPORTED] > 0.99
    for name in ("theta-increments", "jacobian-increments"):
        other = judged[True][name].estimates[1]
        assert other.system == "Ritter's one map", "beside, another system"
        assert other.value == pytest.approx(np.exp(-WORSE), rel=0.05)
    assert {number.value for number in judged[False]["identity"].estimates} == {0.01}
    finding = judged[True]["speed-up"]
    assert finding.estimates[0].value == pytest.approx(70, rel=0.1)
    assert finding.published == "a factor of 70"


def test_without_results_nothing_is_judged(study, tmp_path):
    assert judge(Evidence(study, tmp_path)) == ()
    other = changed(study, name="mine")
    assert judge(Evidence(other, tmp_path)) == ()
