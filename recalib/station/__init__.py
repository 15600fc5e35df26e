"""Arms that move and measure by themselves: a calibration that goes on while it is watched."""
