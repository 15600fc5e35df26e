"""The campaign: every variant, tuned in many setups, each with its own reading of the paper."""
