"""Ground truth: it leaves the world towards recorder and metrics only."""
