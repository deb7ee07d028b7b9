"""Exports of runs and robots in the formats of other tools."""
