"""What is said of uneven results is as kept: every number of every claim, table and page."""

import json

import numpy as np
import pandas as pd
import pytest

from replication.campaign import power
from replication.judgement import checks, hierarchy, intervals
from replication.judgement.benchmark import put_together, seconds
from replication.judgement.claims import CLAIMS
from replication.pages import findings, report
from replication.pages.rendering import PAGES
from tests.conftest import ROOT
from tests.kept import plain
from tests.synthetic import Synthetic

UNEVEN = {  # no two errors, and no two ratios, alike
    "ritter_200": [5.3, 2.9],
    ("improved", "translation"): [0.13, 0.017],
    ("improved", "rotation"): [0.11, 0.19],
    "improved_single_map": [0.61, 0.37],
    "improved_theta_values": [0.43, 0.31],
    "improved_jacobian_values": [0.29, 0.23],
    "ritter_equal_visits": [4.1, 2.3],
    "ritter_jacobian_increments": [5.9, 2.7],
}


SAID = {"claims", "summary", "runs", "versions"}  # on several pages, or another one each day


class Uneven(Synthetic):
    """Results that support some claims, and contradict others."""

    def outcomes(self, *_):
        across = {its.column: its for claim in CLAIMS for its in claim.across.values()}
        uneven = np.random.default_rng(7).uniform(0.85, 1.15, len(across))
        means = {
            name: its.comparison.limit * by or 0.3 * (by - 1)
            for (name, its), by in zip(across.items(), uneven, strict=True)
        }
        return super().outcomes(means, 1)

    def horizon(self, *_):
        return super().horizon(55.0)


@pytest.fixture(scope="module")
def results(few, tmp_path_factory):
    its = Uneven(tmp_path_factory.mktemp("kept"), few, final=UNEVEN, noise=0.2)
    its.conclude()
    return its


def test_what_is_measured_for_each_claim_and_its_verdict(results, data_regression):
    judged = json.loads(results.path("claims.json").read_text(encoding="utf-8"))
    assert [claim["id"] for claim in judged] == [claim.id for claim in CLAIMS]
    data_regression.check({claim["id"]: plain(findings._said(claim)) for claim in judged})


# the article says what other pages say, and the index what README.md says
@pytest.mark.parametrize("name", sorted({*PAGES} - {"article.typ", "index.md"}))
def test_what_a_page_may_say(name, results, data_regression):
    page = PAGES[name]
    said = plain(page.context(results.evidence(page.NEEDS)))
    data_regression.check({key: said[key] for key in said.keys() - SAID})


def test_what_the_report_may_say(results, data_regression):
    said = plain(report.context(results.evidence(report.NEEDS)))
    data_regression.check({key: said[key] for key in said.keys() - SAID})


def test_the_tables_of_results(results, data_regression):
    names = "summary", "benchmark", "benchmark_moves", "real"
    tables = {name: pd.read_csv(results.path(f"{name}.csv")) for name in names}
    spent = pd.DataFrame({"learner": [*"baab"], "seconds_per_move": [0.1, 0.7, 0.5, 0.2]})
    data_regression.check(plain(tables | {"seconds": seconds(spent)}))


def test_the_tables_of_the_benchmark_from_its_files(tmp_path, data_regression):
    rng, files = np.random.default_rng(9), []
    for learner in "ab":
        rows = pd.DataFrame({"moves": [0, 5, 9] * 3, "seed": np.repeat([0, 1, 2], 3)})
        for error in ("position_error_cm", "orientation_error_deg"):
            rows[error] = rng.lognormal(size=len(rows))
        rows = rows.assign(scenario="s", learner=learner, seconds_per_move=rng.random(len(rows)))
        files.append(tmp_path / f"{learner}.parquet")
        rows.to_parquet(files[-1])
    tables = put_together(files, ("s",), ("b", "a"), (0.5, 1.0), 4)
    data_regression.check(plain(dict(zip(("errors", "reached", "seconds"), tables, strict=True))))


def test_what_the_check_says_of_a_summary(results, tmp_path, data_regression):
    path = results.path("summary.csv")
    bands = checks.propose(path)
    bands.to_csv(tmp_path / "expected.csv", index=False)
    text = checks.report(path, tmp_path / "expected.csv")
    assert text.endswith("\n")
    data_regression.check({"bands": plain(bands), "text": text.splitlines()[:6]})


UNEVENLY = np.random.default_rng(3).lognormal(size=(5, 4, 2))


def test_intervals_of_uneven_errors(data_regression):
    ours, theirs = UNEVENLY, UNEVENLY[:3, ::-1] ** 1.3

    def rng():
        return np.random.default_rng(2)

    data_regression.check(
        plain(
            {
                "estimate": intervals.estimate(ours[..., 0], rng()),
                "geometric": intervals.geometric(ours[..., 1], rng()),
                "ratio": intervals.ratio(ours[..., 0], theirs[..., 1], rng()),
                "bootstrap": intervals.bootstrap(ours[..., 0].ravel(), rng()),
                "of two": intervals.bootstrap(ours[0, :2, 0], rng()),
                "first within": [
                    intervals.first_within(np.array([3, 7, 9, 20]), ours[0], np.array(limits))
                    for limits in ([1.0, 1.0], [2.0, 3.0], [9.0, 9.0], [0.1, 0.1])
                ],
            }
        )
    )


def test_what_uneven_setups_have_in_common(data_regression):
    rng = np.random.default_rng(4)
    luck = np.repeat([0.1, 0.4], [5, 7])
    values = 0.3 + 0.5 * rng.normal(size=(12, 1)) + luck[:, None] * rng.normal(size=(12, 3))
    of_two = hierarchy.hierarchy(values, luck)
    of_one = hierarchy.hierarchy(values[:6, :2], np.zeros(6))
    alike = hierarchy.hierarchy(np.tile(values[:1], (4, 1)), np.zeros(4))
    data_regression.check(plain({"two": of_two, "one": of_one, "alike": alike}))


def test_the_committed_power_is_of_the_effects_that_are_tried():
    table = pd.read_csv(ROOT / "workflow" / "universes" / "second" / "power.csv")
    assert sorted(table["effect"].unique()) == sorted(power.EFFECTS)
    assert sorted(table["heterogeneity"].unique()) == sorted(power.HETEROGENEITIES)
