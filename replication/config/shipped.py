"""What is shipped with the project: names of folders, and of tables that were measured once."""

SHIPPED = "replication"  # the name of the study that writes README, docs and figures/
RESULTS = "results"
CAMPAIGN = "workflow/campaign"  # setups, and what was measured in them
SECOND = f"{CAMPAIGN}/second.yaml"  # verdicts that stand until the campaign has its own
DEVIATIONS = "workflow/deviations.yaml"  # what changed after a result had been seen


def root_of(study: str) -> str:
    """The folder of the results of the study of this name."""
    return RESULTS if study == SHIPPED else f"{RESULTS}/studies/{study}"
