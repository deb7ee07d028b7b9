"""Baselines: published obstacle avoidance methods."""
