"""The benchmark: suites, entries, their scores and their comparison."""
