"""Starts the processes of runs: forked from one that has loaded everything."""

from collections.abc import Sequence
from functools import cache
from threading import Lock

from hsr8.evaluation.sweep.fork_server import ForkServer
from hsr8.evaluation.sweep.process import Process


class Launcher:
    """Makes a process for every command line; what they are forked from, at the first of them."""

    def __init__(self) -> None:
        self._server: ForkServer | None = None
        self._lock = Lock()

    def start(self, words: Sequence[str]) -> Process:
        """Run the command line ``hsr8 WORDS``.

        Raises:
            OSError: there is no process.
        """
        with self._lock:
            if self._server is not None and self._server.gone:
                self._server.close()
                self._server = None
            if self._server is None:
                self._server = ForkServer()
            return self._server.start(words)

    def close(self) -> None:
        """End what is left."""
        with self._lock:
            if self._server is not None:
                self._server.close()
                self._server = None


@cache
def of_this_process() -> Launcher:
    """The launcher that all runs of a cluster's worker share; it ends with the worker."""
    return Launcher()
