"""Footsteps: commands become footholds."""
