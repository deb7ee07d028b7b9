"""Refusals of robots that cannot walk, and mistakes in the keys of descriptions."""
