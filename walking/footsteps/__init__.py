"""Footstep planning: commands to footholds."""
