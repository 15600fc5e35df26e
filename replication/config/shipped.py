"""Names of folders, and of the tables that are shipped with the project."""

SHIPPED = "replication"  # the name of the study that writes README, docs and figures/
RESULTS = "results"
CAMPAIGN = "workflow/campaign"  # setups, and measurements in them
DESIGN = f"{CAMPAIGN}/design.csv"
OUTCOMES = f"{CAMPAIGN}/outcomes.csv"  # all outcomes of the campaign
FEWEST = 20  # setups: with fewer there is no verdict (docs/registration.md)
UNTRAINED = f"{CAMPAIGN}/untrained.csv"  # measurements in every setup without a learner
HALFWAY = f"{CAMPAIGN}/halfway.csv"  # Ritter's map between its last two lengths
DEVIATIONS = "workflow/deviations.yaml"  # changes after a result had been seen


def root_of(study: str) -> str:
    """The folder of the results of a study, by its name."""
    return RESULTS if study == SHIPPED else f"{RESULTS}/studies/{study}"
