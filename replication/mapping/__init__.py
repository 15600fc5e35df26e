"""What the paper says of the mapping and of the cells, before it trains a learner."""
