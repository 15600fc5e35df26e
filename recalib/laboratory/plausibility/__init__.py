"""Checks of what a user gives against one another, before and after the fit."""
