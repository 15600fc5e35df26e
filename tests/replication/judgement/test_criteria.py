"""Claims are judged by what was registered; limits and rules have digests in deviations.yaml."""

from replication.judgement.claims import CLAIMS
from replication.judgement.verdicts import CORRELATION, RATIO, Comparison

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
    "speed-up": {"both systems": ("factor", Comparison(50, below=False))},
    "rough-search": {"improved system": ("remaining_rough", TENTH)},
    "local-units": {"radial units": ("radial", RATIO)},
}


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
