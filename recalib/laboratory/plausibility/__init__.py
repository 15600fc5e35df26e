"""Checks of a user's inputs against each other, before and after the fit."""
