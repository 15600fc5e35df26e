"""The paper's claims: what was measured for each, and the verdict by the criterion that was written down before."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from recalib.study.evidence.results import ERRORS, Evidence
from recalib.study.evidence.speedup import speed_up
from recalib.study.experiments import search
from recalib.study.mapping.propagation import integral_ratios
from recalib.study.statistics import Estimate, paired_ratio, share

SUPPORTED, NOT_SUPPORTED = "supported", "not supported"


@dataclass
class Finding:
    """What was measured: labelled numbers, their intervals where they have one, whether the criterion holds, and a note."""

    holds: bool
    measured: dict[str, float]
    interval: dict[str, tuple[float, float]] = field(default_factory=dict)
    note: str = ""

    @classmethod
    def of(
        cls, holds: bool, estimates: Mapping[str, Estimate], note: str = "", **measured: float
    ) -> "Finding":
        """A finding of estimates, and of numbers without an interval."""
        means = {label: estimate.mean for label, estimate in estimates.items()}
        return cls(
            holds,
            means | measured,
            {label: (each.low, each.high) for label, each in estimates.items()},
            note,
        )


def combined(errors: np.ndarray) -> np.ndarray:
    """Geometric mean (seed,) of both errors (seed, 2)."""
    return np.sqrt(errors.prod(axis=1))


def identity(evidence: Evidence, limits: Mapping) -> Finding:
    worst = evidence.history("improved", "intact")[ERRORS].max()
    ritter = evidence.errors("ritter_200", "intact").mean(axis=0)
    note = f"Ritter's values do not leave it there: {ritter[0]:.2g} cm and {ritter[1]:.2g} degrees after 200 iterations."
    return Finding(
        bool((worst < limits["error"]).all()),
        {"largest cm": worst.iloc[0], "largest degrees": worst.iloc[1]},
        note=note,
    )


KINDS = ("position", "orientation")


def left(evidence: Evidence, learner: str, kind: int, scenario: str | None = None) -> Estimate:
    """The share of an initial error that is left at the end."""
    first, last = (
        evidence.errors(learner, scenario, moment)[:, kind] for moment in ("first", "last")
    )
    return paired_ratio(last, first, evidence.rng("left", learner, KINDS[kind]))


def ritter_slow(evidence: Evidence, limits: Mapping) -> Finding:
    estimates = {
        f"{name} left": left(evidence, "ritter_200", kind) for kind, name in enumerate(KINDS)
    }
    return Finding.of(all(each.low > limits["left"] for each in estimates.values()), estimates)


def figure_1(evidence: Evidence, limits: Mapping) -> Finding:
    estimates = {
        f"{name} left": left(evidence, "improved", kind) for kind, name in enumerate(KINDS)
    }
    final = evidence.errors("improved").mean(axis=0)
    holds = all(each.high < limits["left"] for each in estimates.values())
    return Finding.of(holds, estimates, **{"final cm": final[0], "final degrees": final[1]})


def weak_coupling(evidence: Evidence, limits: Mapping) -> Finding:
    table = evidence.study("coupling")
    worst = table.groupby("scenario")[["position", "orientation"]].quantile(0.95)
    labels = {f"{column} commands": worst[column].max() for column in worst}
    strongest = worst.max(axis=1).idxmax()
    return Finding(
        max(labels.values()) <= limits["ratio"],
        labels,
        note=f"Strongest in the scenario {strongest}.",
    )


def switch(evidence: Evidence, limits: Mapping, without: str, added: str) -> Finding:
    """One of the four changes: taken away from the improved system, and added to Ritter's."""
    pairs = {
        "improved with it / without it": ("improved", without),
        "Ritter with it / without it": (added, "ritter_200"),
    }
    estimates = {
        label: paired_ratio(
            *(combined(evidence.errors(each)) for each in pair), evidence.rng(*pair)
        )
        for label, pair in pairs.items()
    }
    by_kind = [
        f"{label}: {ratio[0]:.2f} in position and {ratio[1]:.2f} in orientation"
        for label, pair in pairs.items()
        for ratio in [
            np.exp(np.subtract(*(np.log(evidence.errors(each)).mean(axis=0) for each in pair)))
        ]
    ]
    return Finding.of(
        all(each.high < limits["ratio"] for each in estimates.values()),
        estimates,
        "; ".join(by_kind) + ".",
    )


def increments(evidence: Evidence, limits: Mapping, kind: str, without: str, added: str) -> Finding:
    """One of the switches of section 5, and the reason given for it."""
    finding = switch(evidence, limits, without, added)
    ratio = integral_ratios(evidence.study("propagation"))[kind]
    finding.measured |= {
        "E_upd / E_clas, intact": ratio["intact", 1],
        "E_upd / E_clas, damaged": ratio["damaged", 1],
    }
    # From the intact robot, the Jacobian of f is constant: both integrals are the same up to rounding.
    nearer = bool(ratio["intact", 1] < limits["integrals"] - 1e-6)
    finding.holds &= nearer
    scales, above = ratio["intact"].index, ratio["intact"].to_numpy() >= 1
    if not nearer:
        finding.note += " From the intact robot both integrals are the same: the Jacobian of the identity is constant."
    elif above.any():
        turn = above.argmax()
        finding.note += f" E_upd passes E_clas between {scales[turn - 1]:g} and {scales[turn]:g} times the paper's encoder shifts."
    else:
        finding.note += (
            f" E_upd stays below E_clas up to {scales[-1]:g} times the paper's encoder shifts."
        )
    return finding


def width_order(evidence: Evidence, limits: Mapping) -> Finding:
    trials = evidence.trials("improved_200").query(
        "round == 1"
    )  # later rounds surround one trial, and are not independent
    best = trials.loc[
        search.score(trials).nsmallest(int(np.ceil(limits["best"] * len(trials)))).index
    ]
    estimates = {
        f"{name} map, g_k over g_kl": paired_ratio(
            best[f"{name}/g_k"], best[f"{name}/g_kl"], evidence.rng("widths", name)
        )
        for name in ("position", "orientation")
    }
    position, orientation = estimates.values()
    holds = position.high < limits["ratio"] < orientation.low
    return Finding.of(holds, estimates, f"{len(best)} best of {len(trials)} independent trials.")


def expected_learning(evidence: Evidence, limits: Mapping) -> Finding:
    table = evidence.study("visits")
    away = table[table["distance"] >= limits["away"] * table["width"]]
    deviation = (away["ratio"] - 1).abs()
    agrees = (deviation <= limits["deviation"]) & (deviation <= 3 * away["error"])
    border = table.query("distance == 0 and width <= 0.3")["ratio"].mean()
    note = f"{len(away)} combinations of width and distance; on a face of the workspace, {border:.2f} of the formula."
    return Finding(bool(agrees.all()), {"largest deviation": deviation.max()}, note=note)


def rigid(evidence: Evidence, limits: Mapping) -> Finding:
    holds, estimates, zero = True, {}, {}
    for scenario in ("translation", "rotation", "translation_rotation"):
        for kind, name in enumerate(KINDS):
            label = f"{scenario.replace('_', ' and ')}, {name}"
            if evidence.errors("improved", scenario, "first")[:, kind].max() < 1e-6:
                label += " at most"
                zero[label] = evidence.history("improved", scenario)[ERRORS[kind]].max()
                holds &= zero[label] < limits["zero"]
            else:
                estimates[label] = left(evidence, "improved", kind, scenario)
                holds &= estimates[label].high < limits["left"]
    return Finding.of(bool(holds), estimates, **zero)


def initial_error(evidence: Evidence, limits: Mapping) -> Finding:
    table = evidence.assignments()
    below = {error: float((table[error] < evidence.published[error]).mean()) for error in ERRORS}
    nearest = table.loc[table["distance"].idxmin()]
    note = (
        f"Of {len(table):,} assignments, {int((table['distance'] <= 0.05).sum())} are within 5 % of both; the nearest gives"
        f" {nearest[ERRORS[0]]:.2f} cm and {nearest[ERRORS[1]]:.2f} degrees. The home of the robot was chosen so that such"
        " errors occur, so this says that they are possible, not that they are likely."
    )
    holds = all(limits["tail"] <= each <= 1 - limits["tail"] for each in below.values())
    labels = (
        f"assignments below {value:g} {error.split('_')[-1]}"
        for error, value in evidence.published.items()
    )
    return Finding(holds, dict(zip(labels, below.values(), strict=True)), note=note)


def faster(evidence: Evidence, limits: Mapping) -> Finding:
    factor = speed_up(
        evidence.ladder("ritter"), evidence.ladder("improved"), 200, evidence.rng("speed-up")
    )
    note = f"Ritter's needs {200 * factor.mean:,.0f} iterations for the errors that the improved system has after 200."
    final, double = (
        evidence.errors(learner).mean(axis=0) for learner in ("improved", "ritter_double")
    )
    if (double > final).any():
        most = evidence.config["learners"]["ritter_double"]["iterations"]
        note += (
            f" With twice the cells, the other reading of the same number of neurons, it does not get there in {most:,}: a"
            f" factor above {most / 200:.0f}, as published."
        )
    return Finding.of(factor.low >= limits["factor"], {"factor": factor}, note)


def rough_search(evidence: Evidence, limits: Mapping) -> Finding:
    shares = {}
    for label, training in (("improved", "improved_200"), ("Ritter", "ritter_10000")):
        trials = evidence.trials(training)
        within = (
            search.score(trials[trials["round"] == 1])
            <= limits["factor"] * search.score(trials).min()
        )
        shares[label] = share(within, evidence.rng("rough", label))
    return Finding.of(shares["improved"].low >= limits["share"], shares)


def controller_kept(evidence: Evidence, limits: Mapping) -> Finding:
    table = evidence.study("replay")
    difference = float(table["difference"].max())
    return Finding(
        difference <= limits["difference"],
        {"largest difference": difference},
        note=f"{len(table)} arrays compared.",
    )


MEASURES: dict[str, Callable[[Evidence, Mapping], Finding]] = {
    "identity": identity,
    "ritter-slow": ritter_slow,
    "weak-coupling": weak_coupling,
    "separate-maps": partial(switch, without="improved_single_map", added="ritter_separate_maps"),
    "width-order": width_order,
    "theta-increments": partial(
        increments, kind="theta", without="improved_theta_values", added="ritter_theta_increments"
    ),
    "jacobian-increments": partial(
        increments,
        kind="jacobian",
        without="improved_jacobian_values",
        added="ritter_jacobian_increments",
    ),
    "expected-learning": expected_learning,
    "schedule": partial(switch, without="improved_exponential", added="ritter_equal_visits"),
    "rigid": rigid,
    "initial-error": initial_error,
    "figure-1": figure_1,
    "speed-up": faster,
    "rough-search": rough_search,
    "controller-kept": controller_kept,
}


def missing(config: Mapping) -> list[str]:
    """What the claims need and the configuration's experiments lack."""
    experiments = config["experiments"]
    needed = {
        "scenarios": [
            "intact",
            "translation",
            "rotation",
            "translation_rotation",
            config["search"]["scenario"],
        ],
        "learners": ["improved", "ritter_200", "ritter"],
        "paper": [
            "ritter_double",
            *(
                f"improved_{without}"
                for without in ("single_map", "theta_values", "jacobian_values", "exponential")
            ),
            *(
                f"ritter_{added}"
                for added in (
                    "separate_maps",
                    "theta_increments",
                    "jacobian_increments",
                    "equal_visits",
                )
            ),
        ],
        "ladder": ["improved", "ritter"],
    }
    lacking = [
        f"experiments.{key}: {name}"
        for key, names in needed.items()
        for name in names
        if name not in experiments[key]
    ]
    lacking += [] if 1 in config["studies"]["scales"] else ["studies.scales: 1"]
    return lacking + (
        []
        if 200 in experiments["ladder"].get("improved", [])
        else ["experiments.ladder.improved: 200"]
    )


def judge(criteria: list[Mapping], evidence: Evidence) -> list[dict]:
    """Every claim with what was measured and its verdict, as the contract of claims.json asks."""

    def number(value: float) -> float | None:
        return float(f"{value:.4g}") if np.isfinite(value) else None

    judged = []
    for claim in criteria:
        finding = MEASURES[claim["id"]](evidence, claim["limits"])
        judged.append(
            {key: claim[key] for key in ("id", "section", "statement", "published")}
            | {
                "measured": {label: number(value) for label, value in finding.measured.items()},
                "interval": {
                    label: [number(low), number(high)]
                    for label, (low, high) in finding.interval.items()
                },
                "criterion": claim["criterion"],
                "verdict": SUPPORTED if finding.holds else NOT_SUPPORTED,
                "note": finding.note,
            }
        )
    return judged
