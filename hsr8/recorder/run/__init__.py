"""Writing and reading of run folders."""
