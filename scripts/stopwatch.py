"""Time spent in methods of a running program, each without the time of the others that it calls.

Processor time, which other work on the machine hardly changes: of the calling thread and,
separately, of all others, which draw or write for one stage while the loop is in the next. Garbage
collections and the first call of each stage, which loads compiled code, are listed separately.
"""

import gc
from collections import defaultdict
from functools import wraps
from time import process_time, thread_time

import numpy as np


class Stopwatch:
    """Times methods by replacing them in their classes; use it as a context."""

    def __init__(self) -> None:
        self.times: dict[str, list[float]] = defaultdict(list)
        self.first: dict[str, float] = {}
        self.collections: list[float] = []
        self._collection_start = 0.0
        self._beside: dict[str, float] = defaultdict(float)
        self._inner = [[0.0, 0.0]]
        self._replaced: list[tuple[type, str, object]] = []

    def watch(self, owner: type, method: str, stage: str) -> None:
        """Count every call of a method, less the time of watched calls in it, to a stage."""
        original, inner = getattr(owner, method), self._inner
        times, first = self.times[stage], self.first

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
                if stage in first:
                    times.append(own - own_inner)
                    self._beside[stage] += others - others_inner
                else:
                    first[stage] = own - own_inner
                inner[-1][0] += own
                inner[-1][1] += others

        self._replaced.append((owner, method, owner.__dict__.get(method)))
        setattr(owner, method, timed)

    def _collect(self, phase: str, _info: object) -> None:
        """Take a garbage collection out of the stage that it interrupts."""
        if phase == "start":
            self._collection_start = thread_time()
            return
        self.collections.append(thread_time() - self._collection_start)
        self._inner[-1][0] += self.collections[-1]

    def __enter__(self) -> "Stopwatch":
        gc.callbacks.append(self._collect)
        return self

    def __exit__(self, *error: object) -> None:
        """Put the methods back."""
        gc.callbacks.remove(self._collect)
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
