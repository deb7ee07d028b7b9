"""A process that runs one command line of hsr8."""

import os
import subprocess
import sys
from collections.abc import Sequence
from typing import Protocol

ATTENDED = "hsr8.cli.attended"  # runs a command that ends with its parent
ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


class Process(Protocol):
    """What a sweep asks of a process; `subprocess.Popen` is one."""

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


def start(words: Sequence[str]) -> Process:
    """Run the command line ``hsr8 WORDS`` in a new process."""
    process: subprocess.Popen[str] = subprocess.Popen(
        [sys.executable, "-m", ATTENDED, str(os.getpid()), *words],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        errors="replace",
        env=environment(),
        start_new_session=True,  # Ctrl-C is the sweep's to answer
    )
    return process
