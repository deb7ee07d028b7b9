"""Getting up after a fall."""
