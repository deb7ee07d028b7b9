"""Signals: SIGINT (Ctrl-C), SIGTERM of schedulers and `timeout`, and the end of the parent.

python signals.py PARENT PROGRAM ARGUMENT...   becomes a program that ends with the parent
"""

import ctypes
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from types import FrameType
from typing import Any

PR_SET_PDEATHSIG = 1
ORPHAN = 130  # exit code of a process whose parent ended before the signal was set


@contextmanager
def on_signals(
    numbers: tuple[int, ...], handler: Callable[[int, FrameType | None], Any]
) -> Iterator[None]:
    """Handle signals in a context; the handlers before it are restored.

    An ignored signal stays ignored; outside of the main thread there are no handlers.
    """
    before = {}
    if threading.current_thread() is threading.main_thread():
        handled = [n for n in numbers if signal.getsignal(n) is not signal.SIG_IGN]
        before = {number: signal.signal(number, handler) for number in handled}
    try:
        yield
    finally:
        for number, previous in before.items():
            signal.signal(number, previous)


def like_ctrl_c() -> AbstractContextManager[None]:
    """Return a context in which SIGTERM raises KeyboardInterrupt."""
    return on_signals((signal.SIGTERM,), signal.default_int_handler)


def stop_on_signals(stop: Callable[[], object]) -> AbstractContextManager[None]:
    """Return a context in which the first signal calls `stop`; a second one ends at once."""

    def handle(number: int, frame: FrameType | None) -> None:
        signal.signal(number, signal.default_int_handler)
        stop()

    return on_signals((signal.SIGINT, signal.SIGTERM), handle)


def end_with_parent(parent: int, number: int = signal.SIGTERM) -> bool:
    """Let the kernel send this process a signal when its parent ends.

    Args:
        parent: process id.
        number: number of the signal.

    Returns:
        Whether the parent still runs.
    """
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, number)
    return os.getppid() == parent


def with_parent_watch(command: Sequence[str]) -> list[str]:
    """Return the command line of a process that becomes `command` and ends with this process."""
    isolated = (sys.executable, "-I", "-S", __file__)  # no modules of the current folder
    return [*isolated, str(os.getpid()), *command]


def main(arguments: list[str]) -> int:
    """Become the program in `arguments`, which begin with the process id of the parent."""
    parent, *command = arguments
    if end_with_parent(int(parent)):
        os.execv(command[0], command)
    return ORPHAN


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
