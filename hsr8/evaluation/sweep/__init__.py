"""Sweeps: one scenario over many seeds, each run in a process of its own."""
