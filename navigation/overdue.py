"""When a look is overdue: its age over the time to contact, both within bounds."""

LEAST_TIME = 0.4
"""Shortest time to contact counted [s]."""
AGE_LIMIT = 8.0
"""Age of ground from which nothing grows worse [s]."""
