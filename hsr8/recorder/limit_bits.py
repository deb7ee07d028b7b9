"""Limited commands in a table: the active limits in one integer, one bit each."""

import numpy as np

from hsr8.record import TickRecord
from walking.arrays import Array
from walking.command_limits import Limit

LIMITS = tuple(Limit)
"""Limits in the order of their bits."""
BITS = {limit: 1 << k for k, limit in enumerate(LIMITS)}


def limit_bits(limits: tuple[Limit, ...]) -> int:
    """Return the bits of active limits."""
    bits = 0
    for limit in limits:
        bits |= BITS[limit]
    return bits


def limits_of(record: TickRecord) -> int:
    """Return the bits of the limits of the command, none without a report."""
    report = record.walking.command_limits
    return 0 if report is None else limit_bits(report.limits)


def limited_command_of(record: TickRecord) -> Array | tuple[float, ...]:
    """Return the command before its limits (3,) [m/s, m/s, rad/s], NaN without a report."""
    report = record.walking.command_limits
    return np.full(3, np.nan) if report is None else report.commanded.velocity
