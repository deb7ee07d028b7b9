"""Images and videos of recorded runs, and the Rerun viewer."""
