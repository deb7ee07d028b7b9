"""Files that are whole, or say what they lack."""
