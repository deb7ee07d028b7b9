"""Files and folders: atomic output, text."""
