"""Limited commands in a table: the active limits in one integer, one bit each."""

from walking.command import Limit

LIMITS = tuple(Limit)
"""Limits in the order of their bits."""
BITS = {limit: 1 << k for k, limit in enumerate(LIMITS)}


def limit_bits(limits: tuple[Limit, ...]) -> int:
    """Return the bits of active limits."""
    bits = 0
    for limit in limits:
        bits |= BITS[limit]
    return bits
