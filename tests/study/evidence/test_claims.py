"""Verdicts follow from the numbers: judged on results that support each claim, or contradict it."""

import json
import math
import re

import numpy as np
import pandas as pd
import pytest

from recalib.study.evidence.claims import CLAIMS, judging, missing
from recalib.study.evidence.claims.claim import Claim, Finding, Limit, above, below, every
from recalib.study.evidence.claims.integrals import _where_it_ends
from recalib.study.evidence.claims.speed_up import READINGS
from recalib.study.evidence.needs import Needs
from recalib.study.evidence.results import Evidence, Undeclared
from recalib.study.evidence.words import measured
from recalib.study.measured import ERRORS
from recalib.study.statistics import Estimate
from tests.made_up import INITIAL, MadeUp

IDS = [claim.id for claim in CLAIMS]


@pytest.fixture(scope="module")
def supporting(few, tmp_path_factory) -> MadeUp:
    return MadeUp(tmp_path_factory.mktemp("supporting"), few)


def test_every_claim_says_all_of_itself():
    assert len(set(IDS)) == len(IDS)
    assert all(claim.criterion and claim.reason and claim.limits for claim in CLAIMS)
    for claim in CLAIMS:
        assert claim.reason.format(**claim.limits)


def test_supporting_evidence_supports_every_claim(supporting):
    assert {claim["id"]: claim["verdict"] for claim in supporting.judge()} == dict.fromkeys(
        IDS, "supported"
    )


def test_what_is_measured_is_what_was_made_up(supporting):
    """But for luck, which is of some hundredths for a mean over searches and seeds."""
    cm, deg = INITIAL
    switches = {
        "improved with it / without it": 0.1 / 0.4,
        "Ritter with it / without it": np.sqrt(4 * 2 / (5 * 3)),
    }
    integrals = {"E_upd / E_clas, intact": 0.1, "E_upd / E_clas, damaged": 0.1}
    expected = {
        "identity": {"largest cm": 1e-9, "largest degrees": 1e-9},
        "ritter-slow": {"position left": 5 / cm, "orientation left": 3 / deg},
        # 95 % of what is spread evenly from half to one and a half of it
        "weak-coupling": {"position commands": 1.45 * 0.02, "orientation commands": 1.45 * 0.05},
        "width-order": {
            "position map, g_k over g_kl": 0.3,
            "orientation map, g_k over g_kl": 1 / 0.3,
        },
        **dict.fromkeys(("theta-reason", "jacobian-reason"), integrals),
        "expected-learning": {"largest deviation": 0.01},
        **dict.fromkeys(
            ("separate-maps", "theta-increments", "jacobian-increments", "schedule"), switches
        ),
        "rigid": {
            "translation, position": 0.1 / cm,
            "rotation, position": 0.1 / cm,
            "rotation, orientation": 0.1 / deg,
            "translation and rotation, position": 0.1 / cm,
            "translation and rotation, orientation": 0.1 / deg,
            "translation, orientation at most": 1e-9,
        },
        "initial-error": {
            "assignments below 8.3 cm": 14 / 41,
            "assignments below 4.7 deg": 14 / 41,
        },
        "figure-1": {
            "position left": 0.1 / cm,
            "orientation left": 0.1 / deg,
            "final cm": 0.1,
            "final degrees": 0.1,
        },
        "rough-search": {"improved": 0.3, "Ritter": 0.3},
        "controller-kept": {"largest difference": 0.0},
    }
    found = {claim["id"]: claim["measured"] for claim in supporting.judge()}
    assert found.pop("speed-up") == dict.fromkeys([f"factor, {x}" for x in READINGS.values()])
    assert found == {name: pytest.approx(its, rel=0.15, abs=0) for name, its in expected.items()}


def test_the_contract_of_claims_json_holds(supporting):
    keys = ["id", "section", "statement", "published", "measured", "interval", "criterion"]
    for claim in json.loads(json.dumps(supporting.judge(), allow_nan=False)):
        assert list(claim) == [*keys, "verdict", "note", "universes", "systems"]
        assert claim["measured"] and measured(claim)
        assert set(claim["interval"]) <= set(claim["measured"])
        assert "{" not in "".join(claim[key] for key in ("statement", "published", "criterion"))


def test_limits_are_said_in_words():
    said = "{a:word}, {a:percent}, {b:central}, {c}, {d:word}"
    limits = {"a": Limit(0.1), "b": Limit(0.025), "c": Limit(0.001), "d": Limit(2.0)}
    assert said.format(**limits) == "tenth, 10 %, 95 %, 0.001, twice"


def test_a_claim_sees_what_it_declared_and_nothing_else(supporting):
    job = judging(supporting.request)
    for claim in CLAIMS:
        needs = supporting.made(job.claims[claim.id])
        for path in needs.files:
            without = tuple(each for each in needs.files if each != path)
            with pytest.raises(Undeclared, match=path):
                claim.judge(Evidence(needs.model_copy(update={"files": without})))
        for learner in needs.samples:
            left = {name: path for name, path in needs.samples.items() if name != learner}
            with pytest.raises(Undeclared, match=learner):
                claim.judge(Evidence(needs.model_copy(update={"samples": left})))
        for fact in needs.facts:
            left = {name: value for name, value in needs.facts.items() if name != fact}
            with pytest.raises((Undeclared, KeyError), match=fact):
                claim.judge(Evidence(needs.model_copy(update={"facts": left})))


def test_needs_travel_as_text(supporting):
    needs = judging(supporting.request).claims["speed-up"]
    assert Needs.model_validate_json(needs.model_dump_json()) == needs


@pytest.mark.parametrize(
    ("claim", "final"),
    [
        ("identity", {("improved", "intact"): [0.002, 0]}),
        ("ritter-slow", {"ritter_200": [1.0, 3.0]}),
        ("figure-1", {"improved": 1.0}),
        ("separate-maps", {"improved_single_map": 0.05, "ritter_separate_maps": [9.0, 5.0]}),
        ("theta-increments", {"improved_theta_values": 0.05, "ritter_theta_increments": 4.0}),
        ("jacobian-increments", {"improved_jacobian_values": 0.1, "ritter_jacobian_increments": 9}),
        ("schedule", {"improved_exponential": 0.05, "ritter_equal_visits": [5.0, 3.0]}),
        ("rigid", {("improved", "rotation"): [0.5, 0.1]}),
        ("rigid", {("improved", "translation"): [0.1, 0.02]}),
        ("speed-up", {"ritter_2000": 0.05, "ritter_double_2000": 0.05}),
    ],
)
def test_contradicting_errors_change_the_verdict(few, tmp_path, claim, final):
    assert MadeUp(tmp_path, few, final).verdict(claim) == "not supported"


@pytest.mark.parametrize(
    ("claim", "final"),
    [
        ("ritter-slow", {"ritter_200": [0.25 * 8.3, 3.0]}),
        ("figure-1", {"improved": [0.83, 0.1]}),
        ("rigid", {("improved", "rotation"): [0.05 * 8.3, 0.1]}),
        # neither helps
        ("separate-maps", {"improved_single_map": 0.1, "ritter_separate_maps": [5.0, 3.0]}),
        # one helps, and one harms
        ("schedule", {"improved_exponential": 0.05}),
        # the readings of "the same number of neurons" do not agree
        ("speed-up", {"ritter_2000": 0.05}),
        ("speed-up", {"ritter_double_2000": 0.05}),
        # they do not get there, but in many repetitions of the study they would
        ("speed-up", {"ritter": 0.105, "ritter_double": 0.105}),
    ],
)
def test_errors_between_change_the_verdict_to_undecided(few, tmp_path, claim, final):
    assert MadeUp(tmp_path, few, final).verdict(claim) == "undecided"


def test_a_change_that_helps_one_system_alone_is_supported_for_that_one(few, tmp_path):
    made_up = MadeUp(tmp_path, few, {"ritter_jacobian_increments": [5.0, 3.0]})
    judged = made_up.judged("jacobian-increments")
    assert judged["verdict"] == "supported"
    verdicts = [system["verdict"] for system in judged["systems"].values()]
    assert verdicts == ["supported", "undecided"]


def test_whole_intervals_are_judged_three_ways():
    inside, low, high = (Estimate(1.0, *bounds) for bounds in ((0.9, 1.1), (0.8, 0.9), (1.1, 1.2)))
    assert [below(each, 1.0) for each in (inside, low, high)] == [None, True, False]
    assert [above(each, 1.0) for each in (inside, low, high)] == [None, False, True]
    assert [every(each) for each in ([True, True], [True, None], [None, False])] == [
        True,
        None,
        False,
    ]


def test_contradicting_measurements_change_the_verdict(few, tmp_path):
    made_up = MadeUp(tmp_path, few)
    for claim, name, table in (
        ("weak-coupling", "coupling", made_up.coupling().assign(position=0.2)),
        ("theta-reason", "propagation", made_up.propagation(1.2)),
        ("jacobian-reason", "propagation", made_up.propagation(1.0)),
        ("expected-learning", "visits", made_up.visits().assign(ratio=1.2, error=0.1)),
        ("controller-kept", "replay", made_up.replay().assign(difference=1e-9)),
    ):
        made_up.write(made_up.layout.mapping(name), table)
        assert made_up.verdict(claim) == "not supported", claim


@pytest.mark.parametrize(
    ("ratio", "error", "verdict"),
    [
        (1.04, 0.02, "supported"),  # within 5 %, and within three standard errors
        (1.04, 0.01, "not supported"),  # not within these
        (0.94, 0.04, "not supported"),  # not within 5 %
    ],
)
def test_the_expected_learning_is_held_to_both_of_its_limits(few, tmp_path, ratio, error, verdict):
    made_up = MadeUp(tmp_path, few)
    visits = made_up.visits().assign(ratio=ratio, error=error)
    made_up.write(made_up.layout.mapping("visits"), visits)
    assert made_up.verdict("expected-learning") == verdict


def test_the_note_says_between_which_shifts_the_reason_ends():
    ratios = pd.Series([0.1, 0.2, 0.5, 0.9, 1.5], index=[0.1, 0.5, 1.0, 4.0, 8.0])
    assert _where_it_ends(ratios).startswith(
        "E_upd passes E_clas between 4 and 8 times the paper's"
    )
    assert "below E_clas up to 4 times the paper's" in _where_it_ends(ratios[:4])


def test_contradicting_trials_change_the_verdict(few, tmp_path):
    made_up = MadeUp(tmp_path, few)
    trials = made_up.trials("improved")
    swapped = {"position/g_k": "position/g_kl", "position/g_kl": "position/g_k"}
    made_up.sample("improved", trials.rename(columns=swapped))
    assert made_up.verdict("width-order") == "not supported"
    blind = np.where(trials.index % 100 == 0, 0.01, 3.0)
    made_up.sample("improved", trials.assign(score=blind))
    assert made_up.verdict("rough-search") == "not supported"


def test_unusual_initial_errors_change_the_verdict(few, tmp_path):
    published = few.paper_damage.published.model_copy(update={ERRORS[0]: 30.0})
    damage = few.paper_damage.model_copy(update={"published": published})
    made_up = MadeUp(tmp_path, few.model_copy(update={"paper_damage": damage}))
    judged = made_up.judged("initial-error")
    assert judged["verdict"] == "not supported"
    assert judged["statement"] == "This damage gives initial errors of 30.0 cm and 4.7 degrees."


@pytest.mark.parametrize(
    ("rung", "verdict", "bound"), [(200, "undecided", "1"), (20_000, "supported", "100")]
)
def test_the_highest_rung_is_a_lower_bound_and_nothing_more(few, tmp_path, rung, verdict, bound):
    """Ritter's never gets there: that supports the factor as far as its ladder reaches."""
    ladder = {"improved": few.experiments.ladder["improved"], **dict.fromkeys(READINGS, (rung,))}
    its = few.model_copy(
        update={"experiments": few.experiments.model_copy(update={"ladder": ladder})}
    )
    final = {f"{learner}_{rung}": [5.0, 3.0] for learner in READINGS}
    judged = MadeUp(tmp_path, its, final).judged("speed-up")
    assert judged["verdict"] == verdict
    assert judged["measured"] == {f"factor, {name}": None for name in READINGS.values()}
    assert judged["note"].count(f"all that is known is a factor above {bound}") == 2
    assert "published" not in judged["note"]


def test_what_gets_there_in_its_shortest_training_has_a_factor_of_at_most_that(few, tmp_path):
    """Nothing less was tried: so nobody knows, and least of all that it does not get there."""
    judged = MadeUp(tmp_path, few, {"ritter_200": 0.05}).judged("speed-up")
    first, other = READINGS.values()
    assert judged["verdict"] == "undecided"
    assert judged["measured"] == {f"factor, {first}": 1, f"factor, {other}": None}
    assert list(judged["interval"]) == [f"factor, {other}"]
    assert "gets there in 200: all that is known is a factor of at most 1 and" in judged["note"]
    assert judged["note"].count("does not get there") == 1


def test_a_single_search_has_no_interval_to_say(study, tmp_path):
    once = study.search.model_copy(update={"searches": 1, "searches_long": 1})
    made_up = MadeUp(tmp_path, study.model_copy(update={"name": "once", "search": once}))
    judged = made_up.judged("ritter-slow")
    assert judged["verdict"] == "undecided" and judged["interval"] == {}
    assert re.fullmatch(r"position left: 0\.\d+; orientation left: 0\.\d+", measured(judged))


def test_a_number_that_is_missing_decides_nothing():
    missing, unbounded = (math.nan, 2.0), (3.0, np.inf)
    assert Finding(True, {"factor": math.nan}).systems == {"": None}
    assert Finding(False, {"factor": 1.0}, {"factor": missing}).systems == {"": None}
    assert Finding(True, {"factor": np.inf}, {"factor": unbounded}).systems == {"": True}


def test_what_the_claims_lack_is_told_by_key(study):
    assert missing(study) == []

    def lacking(**update):
        plan = study.experiments.model_copy(update=update)
        return missing(study.model_copy(update={"experiments": plan}))

    assert lacking(scenarios=("intact", "links_encoders")) == [
        "experiments.scenarios: translation",
        "experiments.scenarios: rotation",
        "experiments.scenarios: translation_rotation",
    ]
    assert lacking(learners=("improved", "ritter")) == ["experiments.learners: ritter_200"]
    assert lacking(switches=False) == ["experiments.switches: true"]
    rungs = dict.fromkeys(READINGS, (200, 10_000))
    assert lacking(ladder=rungs | {"improved": (50,)}) == ["experiments.ladder.improved: 200"]
    assert lacking(ladder={"improved": (200,), "ritter": (200, 10_000)}) == [
        "experiments.ladder.ritter_double"
    ]
    coarse = study.mapping.model_copy(update={"scales": (2.0,)})
    assert missing(study.model_copy(update={"mapping": coarse})) == ["mapping.scales: 1"]


def test_adding_a_claim_touches_its_file_and_the_list_alone(supporting):
    claim = Claim(
        id="new",
        section="1",
        statement="There are {iterations}.",
        short="There are {}",
        published="no number",
        limits={"most": Limit(1000)},
        criterion="At most {most}.",
        reason="Why not.",
        needs=lambda ask: ask.fact("iterations"),
        measure=lambda evidence, limits: Finding(
            evidence.fact("iterations") <= limits["most"], {"n": evidence.fact("iterations")}
        ),
    )
    judged = claim.judge(Evidence(supporting.needs(claim.needs)))
    assert judged["statement"] == "There are 200." and judged["criterion"] == "At most 1000."
    assert judged["verdict"] == "supported"
