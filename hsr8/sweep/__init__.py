"""Sweeps: one scenario over many seeds, one process per run; comparisons and the benchmark."""
