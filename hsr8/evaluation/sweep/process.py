"""A process that runs one command line of hsr8."""

import os
from typing import Protocol

ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


class Process(Protocol):
    """What a sweep asks of a process."""

    @property
    def returncode(self) -> int | None:
        """Exit code, or that of the signal that killed it, negative; None while it runs."""

    def communicate(self, *, timeout: float | None = None) -> tuple[str, str]:
        """Wait for the end; what it wrote to standard output and error.

        Raises:
            subprocess.TimeoutExpired: it takes longer than `timeout` [s].
        """

    def terminate(self) -> None:
        """Ask it to end."""

    def kill(self) -> None:
        """End it."""


def environment() -> dict[str, str]:
    """Environment of a run: one thread, unless the user says otherwise."""
    return {name: "1" for name in ONE_THREAD} | dict(os.environ)
