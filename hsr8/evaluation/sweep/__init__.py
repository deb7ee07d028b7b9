"""Sweeps: one scenario over many seeds, one process per run."""
