"""Automatic recalibration of a damaged robot: a replication of Ruiz de Angulo and Torras (1996)."""
