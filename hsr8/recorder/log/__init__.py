"""The Rerun log: a layer for each thing it shows, written and read back."""
