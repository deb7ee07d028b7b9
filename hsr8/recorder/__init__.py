"""Recorder: run folder and Rerun log, both listeners of the loop."""
