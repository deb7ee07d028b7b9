"""Files and folders: atomic output, bounded reading, JSON lines."""
