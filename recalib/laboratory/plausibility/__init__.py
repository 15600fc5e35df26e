"""Checks of whether a user's inputs agree with each other, before and after the fit."""
