"""Gait: support phases and swing foot."""
