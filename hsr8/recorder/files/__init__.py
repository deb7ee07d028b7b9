"""Layers below the records of a run: atomic, growing, binary and JSON files."""
