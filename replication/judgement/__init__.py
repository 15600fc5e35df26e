"""Evidence: results of all trainings, the verdicts and checks on them, and pages that say so."""
