"""Figures: what each reads is declared in `registry`; drawing starts when it is asked for."""
