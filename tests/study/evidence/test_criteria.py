"""Limits and comparisons are those that were written: to change one is to change it here."""

from recalib.study.evidence.claims import CLAIMS
from recalib.study.evidence.verdicts import CORRELATION, RATIO, WIDEST, Comparison

LIMITS = {
    "identity": {"error": 0.001},  # cm, degrees
    "grid": {"worse": 1.1},
    "ritter-slow": {"left": 0.25},
    "weak-coupling": {"ratio": 0.1, "poses": 0.95},
    "large-neighbourhoods": {},
    "separate-maps": {},
    "widths-position": {},
    "widths-orientation": {},
    "cells-position": {},
    "cells-orientation": {},
    "theta-increments": {},
    "theta-reason": {"share": 0.95},
    "jacobian-increments": {},
    "jacobian-reason": {"share": 0.95},
    "expected-learning": {"deviation": 0.05, "errors": 3, "away": 3},
    "schedule": {},
    "rigid": {},
    "initial-error": {"tail": 0.025},
    "figure-1": {"left": 0.1},
    "speed-up": {"long": 50},
    "rough-search": {"left": 0.1},
    "controller-kept": {"difference": 0},
    "local-units": {},
}
TENTH = Comparison(0.1)
# What is judged is named first; the number is a column of the campaign.
ACROSS = {
    "identity": {"improved system": ("intact", Comparison(0.001))},
    "ritter-slow": {"Ritter's": ("remaining_ritter", Comparison(0.25, below=False))},
    "weak-coupling": {"the mapping": ("coupling", TENTH)},
    "large-neighbourhoods": {"improved system": ("narrow", RATIO)},
    "separate-maps": {
        "Ritter's, 1,000 iterations": ("maps_ritter_late", RATIO),
        "Ritter's, 200 iterations": ("maps_ritter", RATIO),
        "improved system, 200 iterations": ("maps_improved", RATIO),
    },
    "widths-position": {"improved system": ("order_position", CORRELATION)},
    "widths-orientation": {"improved system": ("order_orientation", CORRELATION)},
    "cells-position": {"improved system": ("cells_position", RATIO)},
    "cells-orientation": {"improved system": ("cells_orientation", RATIO)},
    "theta-increments": {
        "improved system": ("theta_improved", RATIO),
        "Ritter's": ("theta_ritter", RATIO),
    },
    "jacobian-increments": {
        "improved system": ("jacobian_improved", RATIO),
        "Ritter's": ("jacobian_ritter", RATIO),
    },
    "schedule": {
        "improved system": ("schedule_improved", RATIO),
        "Ritter's": ("schedule_ritter", RATIO),
    },
    "figure-1": {"improved system": ("remaining", TENTH)},
    "speed-up": {"alternative setups": ("factor", Comparison(50, below=False))},
    "rough-search": {"improved system": ("remaining_rough", TENTH)},
    "local-units": {"radial units": ("radial", RATIO)},
}


def test_limits_are_as_they_were_written():
    assert {claim.id: dict(claim.limits) for claim in CLAIMS} == LIMITS
    assert [claim.id for claim in CLAIMS] == [*LIMITS], "in the order of the paper"


def test_the_bounds_of_equivalence_are_a_tenth():
    assert RATIO == (1, True, (1 / 1.1, 1.1))
    assert CORRELATION == (0, False, (-0.1, 0.1))
    assert WIDEST == 4


def test_claims_are_judged_on_the_systems_and_by_the_numbers_that_were_registered():
    found = {
        claim.id: {name: (its.column, its.comparison) for name, its in claim.across.items()}
        for claim in CLAIMS
        if claim.across
    }
    assert found == ACROSS
    for name, systems in ACROSS.items():
        assert [*found[name]] == [*systems], "the one for which the paper makes it comes first"


def test_logarithms_are_taken_of_all_but_correlations_and_tables_have_names():
    for claim in CLAIMS:
        for across in claim.across.values():
            assert across.logarithmic == (across.comparison is not CORRELATION)
            assert (across.table == "horizon") == (claim.id == "speed-up")
