"""Dashboards of a run, as videos or images."""
