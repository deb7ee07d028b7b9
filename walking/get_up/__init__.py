"""Getting up: from lying to standing."""
