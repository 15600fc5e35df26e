"""What the paper says of the mapping, not of the learner: measured without a training."""
