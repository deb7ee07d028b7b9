"""Evaluation: metrics of a run and whether it passed."""
