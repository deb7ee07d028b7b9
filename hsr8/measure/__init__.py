"""Metrics of a run and its criteria, and their statistics."""
