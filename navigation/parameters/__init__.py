"""Parameters of belief and decisions: their fields are the keys of a scenario."""
