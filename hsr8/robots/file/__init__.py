"""Files of robots: descriptions, where models are, and their readers."""
