"""The head camera: rendered, or geometry alone, with what spoils its images."""
