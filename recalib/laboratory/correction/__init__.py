"""Corrected commands for an unchanged controller."""
