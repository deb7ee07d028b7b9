"""Writing and reading of the Rerun log, one layer per subject."""
