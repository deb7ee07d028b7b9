"""Pace of a run: simulated time against the clock on the wall."""

import time

from hsr8.simulation.record import Tick

TOLERANCE = 0.1  # delay that is not caught up with [s]


class Pace:
    """Upper limit of the pace of a run.

    Args:
        factor: simulated seconds per second, positive.
    """

    def __init__(self, factor: float) -> None:
        self._factor = factor
        self._due: float | None = None  # wall time of the tick at time zero [s]

    def wait(self, tick: Tick) -> None:
        """Wait until a tick is due."""
        now, elapsed = time.perf_counter(), tick.time / self._factor
        if self._due is None or now - self._due - elapsed > TOLERANCE:
            self._due = now - elapsed
        time.sleep(max(0.0, self._due + elapsed - now))
