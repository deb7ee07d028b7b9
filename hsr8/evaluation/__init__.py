"""Evaluation: metrics of a run and its criteria."""
