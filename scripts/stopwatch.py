"""Time spent in methods of a running program, each without the time of the others that it calls.

Processor time, which other work on the machine hardly changes: of the calling thread and,
separately, of all others, which draw or write for one stage while the loop is in the next.
"""

from collections import defaultdict
from functools import wraps
from time import process_time, thread_time

import numpy as np


class Stopwatch:
    """Times methods by replacing them in their classes; use it as a context."""

    def __init__(self) -> None:
        self.times: dict[str, list[float]] = defaultdict(list)
        self._beside: dict[str, float] = defaultdict(float)
        self._inner = [[0.0, 0.0]]
        self._replaced: list[tuple[type, str, object]] = []

    def watch(self, owner: type, method: str, stage: str) -> None:
        """Count every call of a method, less the time of watched calls in it, to a stage."""
        original, times, inner = getattr(owner, method), self.times[stage], self._inner

        @wraps(original)
        def timed(*args: object, **kwargs: object) -> object:
            inner.append([0.0, 0.0])
            own, process = thread_time(), process_time()
            try:
                return original(*args, **kwargs)
            finally:
                own = thread_time() - own
                others = process_time() - process - own
                own_inner, others_inner = inner.pop()
                times.append(own - own_inner)
                self._beside[stage] += others - others_inner
                inner[-1][0] += own
                inner[-1][1] += others

        self._replaced.append((owner, method, owner.__dict__.get(method)))
        setattr(owner, method, timed)

    def __enter__(self) -> "Stopwatch":
        return self

    def __exit__(self, *error: object) -> None:
        """Put the methods back."""
        for owner, method, original in reversed(self._replaced):
            if original is None:
                delattr(owner, method)  # it was inherited
            else:
                setattr(owner, method, original)

    def total(self, *stages: str) -> float:
        """Time in some stages [s]."""
        return sum(sum(self.times[stage]) for stage in stages)

    def beside(self, *stages: str) -> float:
        """Time of all other threads during some stages [s]."""
        return sum(self._beside[stage] for stage in stages)

    def row(self, stage: str) -> tuple[int, float, float]:
        """Calls, mean and 99th percentile [ms] of a stage."""
        times = 1e3 * np.array(self.times[stage] or [0.0])
        return len(self.times[stage]), float(times.mean()), float(np.percentile(times, 99))
