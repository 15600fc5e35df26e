"""Learners: the maps of 1996 and today's, behind one interface."""
