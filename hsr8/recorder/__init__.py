"""Recorder: tables of a run, run folder and Rerun log."""
