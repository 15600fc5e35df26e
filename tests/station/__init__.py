import recalib.station  # noqa: F401  # before anything imports MuJoCo
