"""What is shipped with the project: names of folders, and of tables that were measured once."""

SHIPPED = "replication"  # the name of the study that writes README, docs and figures/
RESULTS = "results"
FIRST = "workflow/universes/first"  # the first campaign: its design, and what was measured
SECOND = "workflow/universes/second"  # the second one, as shipped
DESIGN = f"{SECOND}/design.csv"  # the factors of each universe
REFERENCE = f"{SECOND}/reference.csv"  # the reference study, measured like a universe
EFFORTS = f"{SECOND}/efforts.csv"  # its trainings for the factor of 70, by effort
POWER = f"{SECOND}/power.csv"  # what the campaign can find
FACTORS = "workflow/templates/factors.yaml"  # the factors of each universe in words
DEVIATIONS = "workflow/deviations.yaml"  # what changed after a result had been seen
SEARCHED = "workflow/search"  # samples of the search that are shipped

PIECES = {"outcomes": 32, "horizon": 8}  # setups: what two cores measure in at most an hour


def root_of(study: str) -> str:
    """The folder of the results of the study of this name."""
    return RESULTS if study == SHIPPED else f"{RESULTS}/studies/{study}"


def pieces(table: str, setups: int, root: str = SECOND) -> list[str]:
    """The pieces of a table of the second campaign: outcomes or horizon of so many setups."""
    return [f"{root}/{table}_{number}.csv" for number in range(-(-setups // PIECES[table]))]
