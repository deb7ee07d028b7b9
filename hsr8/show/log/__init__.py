"""Rerun log of a run, one layer per subject."""
