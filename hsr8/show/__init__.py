"""Images, videos and plots of recorded runs, and the Rerun viewer."""
