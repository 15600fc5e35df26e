"""Recordings of an arm before, during and after its recalibration: nothing else imports Rerun."""
