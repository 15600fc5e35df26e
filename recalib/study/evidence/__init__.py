"""Evidence: the results of all runs, the verdicts and checks that rest on them, and the pages that say so."""
