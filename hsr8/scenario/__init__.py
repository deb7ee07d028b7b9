"""Scenarios: what a file may say, and the file read and checked."""
