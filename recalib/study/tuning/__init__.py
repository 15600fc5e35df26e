"""The search for the widths and rates of a learner of the paper, until it has converged."""
