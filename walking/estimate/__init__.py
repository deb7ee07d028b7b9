"""State estimation: measured body, its error against the plan, dead reckoning."""
