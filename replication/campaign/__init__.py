"""The multiverse: the replication in many universes, each with its own reading of the paper."""
