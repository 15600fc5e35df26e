"""What is shipped with the project: names of folders, and of tables that were measured once."""

SHIPPED = "replication"  # the name of the study that writes README, docs and figures/
RESULTS = "results"
CAMPAIGN = "workflow/campaign"  # setups, and what was measured in them
DESIGN = f"{CAMPAIGN}/design.csv"
OUTCOMES = f"{CAMPAIGN}/outcomes.csv"  # the campaign is this one table
FEWEST = 20  # setups: until then no verdict follows from them (docs/registration.md)
UNTRAINED = f"{CAMPAIGN}/untrained.csv"  # what is measured in every setup without a learner
DEVIATIONS = "workflow/deviations.yaml"  # what changed after a result had been seen


def root_of(study: str) -> str:
    """The folder of the results of the study of this name."""
    return RESULTS if study == SHIPPED else f"{RESULTS}/studies/{study}"
