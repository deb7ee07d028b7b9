"""Watch of the functions that Numba compiles at their first call."""

from collections.abc import Callable
from time import perf_counter
from typing import Self

from numba.core import event

from compilation.function import CompiledFunction

COMPILE = "numba:compile"  # event of a function whose code is not on disk


class CompilationWatch(event.Listener):
    """Watch of the functions that this process compiles, used by ``with``.

    Args:
        before: called with the name of the package before each compilation of a function of hsr8.

    Attributes:
        seconds: wall time of compilations so far, with that of `before` [s].
        count: number of compiled functions of hsr8, without those that they call.
    """

    def __init__(self, before: Callable[[str], object] | None = None) -> None:
        self._before = before
        self._depth = 0
        self._started = 0.0
        self.seconds = 0.0
        self.count = 0

    def __enter__(self) -> Self:
        event.register(COMPILE, self)
        return self

    def __exit__(self, *_: object) -> None:
        event.unregister(COMPILE, self)

    def on_start(self, event: event.Event) -> None:
        """Begin a compilation, which may be part of another one."""
        self._depth += 1
        if self._depth > 1:
            return
        self._started = perf_counter()
        function = event.data["dispatcher"]
        if isinstance(function, CompiledFunction):
            self.count += 1
            if self._before is not None:
                self._before(function.__module__.partition(".")[0])

    def on_end(self, event: event.Event) -> None:
        """End a compilation."""
        self._depth -= 1
        if self._depth == 0:
            self.seconds += perf_counter() - self._started
